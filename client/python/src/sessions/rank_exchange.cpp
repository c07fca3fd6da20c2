#include "sessions/rank_exchange.hpp"

#include <pybind11/stl.h>

#include <string>
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
    with_lock([&] { all = bytes_of_ranks(exchange_.attr("gather")(bytes_out(mine))); });
    return all;
}

std::vector<PartExchange::Bytes> RankExchange::all_to_all(std::vector<Bytes> to) {
    std::vector<Bytes> from;
    with_lock([&] {
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
        const py::buffer_info bytes = each.cast<py::buffer>().request();
        const auto* const begin = static_cast<const std::byte*>(bytes.ptr);
        all.emplace_back(begin, begin + bytes.size * bytes.itemsize);
    }
    if (all.size() != ranks_)
        throw InvalidInput("the exchange has given the bytes of " + std::to_string(all.size()) + " ranks, must be of " +
                           std::to_string(ranks_));
    return all;
}

}  // namespace meniscus::python
