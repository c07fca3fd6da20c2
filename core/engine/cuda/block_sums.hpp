// Sums over the threads of a block, of several numbers at once. All threads must call.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// Shared memory of a block.
template <unsigned count>
struct BlockSums {
    std::uint32_t of_warp[block_warps][count];

    /// Each number becomes the sum of those of the threads before; `all` that of all threads.
    __device__ void sum_below(std::uint32_t (&numbers)[count], std::uint32_t (&all)[count]) {
        for (unsigned n = 0; n < count; ++n) {
            std::uint32_t total = 0;
            numbers[n] = sum_of_lanes_below(numbers[n], total);
            if (lane_index() == 0) of_warp[warp_in_block()][n] = total;
        }
        __syncthreads();
        for (unsigned n = 0; n < count; ++n) {
            all[n] = 0;
            for (unsigned w = 0; w < block_warps; ++w) {
                if (w == warp_in_block()) numbers[n] += all[n];
                all[n] += of_warp[w][n];
            }
        }
        __syncthreads();
    }
};

}  // namespace meniscus::cuda
