#include <dlfcn.h>

#include <string>

#include "meniscus/error.hpp"
#include "one_rank.hpp"
#include "ranks.hpp"

namespace meniscus::catalyst {
namespace {

/// Asks the program's own MPI. A communicator is a pointer in some MPIs and an int in others; where it is an int, its
/// Fortran handle is the same, and both are passed in the same register.
int ranks_of(int communicator) {
    using FromFortran = void* (*)(int);
    using SizeOfPointer = int (*)(void*, int*);
    using SizeOfInt = int (*)(int, int*);
    const auto from_fortran = reinterpret_cast<FromFortran>(::dlsym(RTLD_DEFAULT, "MPI_Comm_f2c"));
    void* const size = ::dlsym(RTLD_DEFAULT, "MPI_Comm_size");
    int ranks = 1;
    if (size == nullptr) return ranks;
    if (from_fortran != nullptr)
        reinterpret_cast<SizeOfPointer>(size)(from_fortran(communicator), &ranks);
    else
        reinterpret_cast<SizeOfInt>(size)(communicator, &ranks);
    return ranks;
}

}  // namespace

struct Ranks::Communicator {};

Ranks::Ranks(std::optional<int> communicator) {
    const int ranks = communicator ? ranks_of(*communicator) : 1;
    if (ranks > 1)
        throw NotBuilt("catalyst/mpi_comm of " + std::to_string(ranks) + " ranks",
                       "MPI: build it with cmake -DMENISCUS_CATALYST_MPI=ON, where the mpicc of the simulation is");
}
Ranks::~Ranks() = default;
void Ranks::broadcast(void* /*bytes*/, std::size_t /*count*/) const {}
std::array<int, 2> Ranks::least(std::array<int, 2> numbers) const {
    return numbers;
}
void Ranks::wait_for_all() const {}
meniscus_result Ranks::open_parts(const meniscus_options* options, meniscus_parts** parts) const {
    return open_parts_alone(options, parts);
}

}  // namespace meniscus::catalyst
