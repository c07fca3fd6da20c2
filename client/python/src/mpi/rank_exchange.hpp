// The ranks of a job as processes that exchange, by functions of Python: those of mpi4py.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <vector>

#include "meniscus/parts.hpp"

namespace meniscus::python {

/// Its functions are called without the interpreter's lock, and throw the errors that Python raises.
class RankExchange final : public PartExchange {
public:
    /// exchange: has rank, ranks, gather(bytes), a list of all ranks' bytes or buffers of bytes, and trade(list), of
    /// bytes to each rank, likewise; borrowed, must stay. With the lock.
    explicit RankExchange(const pybind11::object& exchange);

    std::size_t rank() const override { return rank_; }
    std::size_t ranks() const override { return ranks_; }
    std::vector<Bytes> gather(Bytes mine) override;
    void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) override;

private:
    /// With the lock.
    void read_bytes_of_ranks(const pybind11::list& list, std::vector<Bytes>& all) const;

    pybind11::handle exchange_;
    std::size_t rank_;
    std::size_t ranks_;
};

}  // namespace meniscus::python
