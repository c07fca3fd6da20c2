// The threads that work together where steps depend on each other: all of a cooperative grid, or those of its first
// block alone.
#pragma once

#include <cooperative_groups.h>

#include <cstdint>

#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// A block waits for itself a hundred times faster than a grid does: where there is little to do, one block does it
/// all.
class Team {
public:
    __device__ static Team grid() { return Team(false); }
    /// The grid, or its first block if each of its threads then has at most `of_thread` of the elements. All threads of
    /// the grid must give the same numbers.
    __device__ static Team fit_for(std::uint64_t elements, unsigned of_thread) {
        return Team(elements <= std::uint64_t{of_thread} * block_threads);
    }
    /// The same for a part of this team.
    __device__ Team narrowed_to(std::uint64_t elements, unsigned of_thread) const {
        return is_alone_ ? *this : fit_for(elements, of_thread);
    }

    /// Whether this thread is one of the team: only these may call the other functions.
    __device__ bool has_this_thread() const { return !is_alone_ || blockIdx.x == 0; }
    __device__ bool is_alone() const { return is_alone_; }
    __device__ bool is_first_thread() const { return blockIdx.x == 0 && threadIdx.x == 0; }
    __device__ void wait() const {
        if (is_alone_)
            __syncthreads();
        else
            cooperative_groups::this_grid().sync();
    }
    __device__ std::uint64_t threads() const { return loop().step; }
    /// A loop of the team over all elements.
    __device__ GridLoop loop() const { return is_alone_ ? GridLoop{block_threads, threadIdx.x} : GridLoop{}; }
    /// Calls visit(i, part) for all parts of the elements below n. All lanes of a warp have the same part, whose way
    /// through the code may be its own.
    template <unsigned parts, class Visit>
    __device__ void each_part(std::uint64_t n, const Visit& visit) const {
        const std::uint64_t warps = (n + warp_threads - 1) / warp_threads * parts;
        loop().template each<std::uint64_t>(warps * warp_threads, [&](std::uint64_t thread) {
            const std::uint64_t warp = thread / warp_threads;
            const std::uint64_t i = warp / parts * warp_threads + thread % warp_threads;
            if (i < n) visit(i, static_cast<unsigned>(warp % parts));
        });
    }

private:
    __device__ explicit Team(bool is_alone) : is_alone_(is_alone) {}

    bool is_alone_;
};

}  // namespace meniscus::cuda
