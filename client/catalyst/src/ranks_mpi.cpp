#include <meniscus/mpi.h>

#include "one_rank.hpp"
#include "ranks.hpp"

namespace meniscus::catalyst {

struct Ranks::Communicator {
    /// Of our own, so that no message meets one of the simulation's.
    explicit Communicator(MPI_Comm of) { MPI_Comm_dup(of, &handle); }
    /// A program that forgets to finalize Catalyst may have finalized MPI already.
    ~Communicator() {
        int finalized = 0;
        MPI_Finalized(&finalized);
        if (finalized == 0) MPI_Comm_free(&handle);
    }

    MPI_Comm handle = MPI_COMM_NULL;
};

// Without a communicator MPI's world is meant, as ParaView has it; and one process, where MPI was not initialized.
Ranks::Ranks(std::optional<int> communicator) {
    int initialized = 0;
    MPI_Initialized(&initialized);
    if (initialized == 0) return;
    communicator_ = std::make_unique<Communicator>(communicator ? MPI_Comm_f2c(*communicator) : MPI_COMM_WORLD);
    MPI_Comm_rank(communicator_->handle, &rank_);
    MPI_Comm_size(communicator_->handle, &size_);
}
Ranks::~Ranks() = default;

void Ranks::broadcast(void* bytes, std::size_t count) const {
    if (size_ > 1) MPI_Bcast(bytes, static_cast<int>(count), MPI_BYTE, 0, communicator_->handle);
}

std::array<int, 2> Ranks::least(std::array<int, 2> numbers) const {
    std::array<int, 2> least = numbers;
    if (size_ > 1) MPI_Allreduce(numbers.data(), least.data(), 2, MPI_INT, MPI_MIN, communicator_->handle);
    return least;
}

void Ranks::wait_for_all() const {
    if (size_ > 1) MPI_Barrier(communicator_->handle);
}

meniscus_result Ranks::open_parts(const meniscus_options* options, meniscus_parts** parts) const {
    return size_ > 1 ? meniscus_parts_create(communicator_->handle, options, parts) : open_parts_alone(options, parts);
}

}  // namespace meniscus::catalyst
