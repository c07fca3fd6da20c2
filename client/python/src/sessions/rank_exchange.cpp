#include "sessions/rank_exchange.hpp"

#include <pybind11/stl.h>

#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "meniscus/error.hpp"
#include "threads/interpreter_lock.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

py::bytes bytes_out(const PartExchange::Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void with_lock_again(const std::function<void()>& work) {
    std::exception_ptr raised;
    with_lock([&] {
        try {
            work();
        } catch (...) {
            raised = std::current_exception();
        }
    });
    if (raised) std::rethrow_exception(std::move(raised));
}

RankExchange::RankExchange(const py::object& exchange)
    : exchange_(exchange),
      rank_(exchange.attr("rank").cast<std::size_t>()),
      ranks_(exchange.attr("ranks").cast<std::size_t>()) {
    if (rank_ >= ranks_)
        throw InvalidInput("rank is " + std::to_string(rank_) + ", must be below " + std::to_string(ranks_) +
                           ", the number of ranks");
}

std::vector<PartExchange::Bytes> RankExchange::gather(Bytes mine) {
    std::vector<Bytes> all;
    with_lock_again([&] { all = bytes_of_ranks(exchange_.attr("gather")(bytes_out(mine))); });
    return all;
}

std::vector<PartExchange::Bytes> RankExchange::all_to_all(std::vector<Bytes> to) {
    std::vector<Bytes> from;
    with_lock_again([&] {
        py::list given;
        for (Bytes& bytes : to) {
            given.append(bytes_out(bytes));
            bytes = {};  // there may be much
        }
        from = bytes_of_ranks(exchange_.attr("trade")(given));
    });
    return from;
}

std::vector<PartExchange::Bytes> RankExchange::bytes_of_ranks(const py::object& list) const {
    std::vector<Bytes> all;
    for (const py::handle each : list) {
        const auto text = each.cast<std::string_view>();
        const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
        all.emplace_back(begin, begin + text.size());
    }
    if (all.size() != ranks_)
        throw InvalidInput("the exchange has given the bytes of " + std::to_string(all.size()) + " ranks, must be of " +
                           std::to_string(ranks_));
    return all;
}

}  // namespace meniscus::python
