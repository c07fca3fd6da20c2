// The processes of a run: what they agree upon. All of them call these functions in the same order.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "meniscus/meniscus.h"

namespace meniscus::catalyst {

/// ranks_mpi.cpp has them by MPI, on the thread that calls; ranks_alone.cpp for one process, without MPI.
class Ranks {
public:
    /// communicator: catalyst/mpi_comm, a Fortran handle. Throws NotBuilt for more than one rank without MPI.
    explicit Ranks(std::optional<int> communicator);
    ~Ranks();

    int rank() const noexcept { return rank_; }
    int size() const noexcept { return size_; }
    /// Rank 0's bytes, to all.
    void broadcast(void* bytes, std::size_t count) const;
    /// The smallest of what the ranks give, number by number.
    std::array<int, 2> least(std::array<int, 2> numbers) const;
    void wait_for_all() const;
    /// meniscus_parts_create() for these ranks.
    meniscus_result open_parts(const meniscus_options* options, meniscus_parts** parts) const;

private:
    struct Communicator;
    std::unique_ptr<Communicator> communicator_;
    int rank_ = 0;
    int size_ = 1;
};

}  // namespace meniscus::catalyst
