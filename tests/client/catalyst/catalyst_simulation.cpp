// A simulation of several ranks, for ranks_test.cpp: rank 0 reads the number of a frame from each line of its standard
// input, all ranks execute Catalyst, and rank 0 prints the status of the best and the worst rank and the frames that
// were sent. An argument is an option that the last rank alone is given.
#include <mpi.h>

#include <cstdio>
#include <iostream>
#include <optional>

#include "conduit_stand_in.hpp"
#include "support/particles.hpp"

namespace {

using namespace meniscus::test;

void tell(int rank, int status, std::int64_t number) {
    int best = status;
    int worst = status;
    MPI_Reduce(&status, &best, 1, MPI_INT, MPI_MIN, 0, MPI_COMM_WORLD);
    MPI_Reduce(&status, &worst, 1, MPI_INT, MPI_MAX, 0, MPI_COMM_WORLD);
    if (rank == 0) std::cout << best << " " << worst << " " << number << std::endl;
}

std::int64_t sent(const catalyst_impl& implementation) {
    conduit_node params;
    implementation.results(&params);
    const conduit_node* const found = params.find("meniscus/frames_sent");
    return found == nullptr ? -1 : *reinterpret_cast<const std::int64_t*>(found->data);
}

/// The frame `step` of this rank: every particle has one rank, another one from frame to frame; one rank has none, in
/// every other frame not even a channel.
void fill(conduit_node& params, std::vector<float> (&axes)[3], std::int64_t step, int rank, int ranks) {
    for (std::vector<float>& axis : axes) axis.clear();
    params["catalyst/state/timestep"].set(step);
    params["catalyst/state/time"].set(0.5 * static_cast<double>(step));
    const int idle = static_cast<int>(step) % ranks;
    if (rank == idle && step % 2 == 0 && ranks > 1) return;
    const Particles all = splash(static_cast<unsigned>(step), 5);
    for (std::size_t i = 0; i < all.count(); ++i) {
        int owner = static_cast<int>((i * 7 + static_cast<std::size_t>(step)) % static_cast<std::size_t>(ranks));
        if (owner == idle) owner = (owner + 1) % ranks;
        for (std::size_t axis = 0; owner == rank && axis < 3; ++axis) axes[axis].push_back(all.positions[3 * i + axis]);
    }
    conduit_node& channel = params["catalyst/channels/fluid"];
    channel["type"].set(std::string("mesh"));
    channel["data/coordsets/coords/type"].set(std::string("explicit"));
    for (std::size_t axis = 0; axis < 3; ++axis)
        channel["data/coordsets/coords/values/" + std::string(1, "xyz"[axis])].point(axes[axis].data(),
                                                                                     axes[axis].size());
    channel["data/topologies/particles/type"].set(std::string("points"));
    channel["data/topologies/particles/coordset"].set(std::string("coords"));
}

std::optional<std::int64_t> next_step(int rank) {
    std::int64_t step = -1;
    if (rank == 0 && !(std::cin >> step)) step = -1;
    MPI_Bcast(&step, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
    return step < 0 ? std::nullopt : std::optional(step);
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    int rank = 0;
    int ranks = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    {
        const CatalystStandIn catalyst;
        conduit_node params;
        params["catalyst/mpi_comm"].set(static_cast<std::int64_t>(MPI_Comm_c2f(MPI_COMM_WORLD)));
        if (argc > 1 && rank == ranks - 1) params["catalyst/scripts/surface/args"].append().set(std::string(argv[1]));
        tell(rank, catalyst->initialize(&params), 0);
        std::vector<float> axes[3];
        while (const auto step = next_step(rank)) {
            conduit_node frame;
            fill(frame, axes, *step, rank, ranks);
            const int status = catalyst->execute(&frame);
            tell(rank, status, sent(*catalyst));
        }
        tell(rank, catalyst->finalize(&params), 0);
    }
    MPI_Finalize();
    return 0;
}
