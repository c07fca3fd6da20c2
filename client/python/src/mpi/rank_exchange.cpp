#include "mpi/rank_exchange.hpp"

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
    with_lock([&] { read_bytes_of_ranks(exchange_.attr("gather")(bytes_out(mine)), all); });
    return all;
}

void RankExchange::all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) {
    with_lock([&] {
        py::list given;
        for (const Bytes& bytes : to) given.append(bytes_out(bytes));
        read_bytes_of_ranks(exchange_.attr("trade")(given), from);
    });
}

void RankExchange::read_bytes_of_ranks(const py::list& list, std::vector<Bytes>& all) const {
    if (list.size() != ranks_)
        throw InvalidInput("the exchange has given the bytes of " + std::to_string(list.size()) +
                           " ranks, must be of " + std::to_string(ranks_));
    all.resize(ranks_);
    for (std::size_t rank = 0; const py::handle each : list) {
        const py::buffer_info bytes = each.cast<py::buffer>().request();
        const auto* const begin = static_cast<const std::byte*>(bytes.ptr);
        all[rank++].assign(begin, begin + bytes.size * bytes.itemsize);
    }
}

}  // namespace meniscus::python
