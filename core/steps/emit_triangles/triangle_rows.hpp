// The cube table by triangles, for a block of threads.
#pragma once

#include <cstdint>
#include <tuple>

#include "engine/cuda/warp.hpp"
#include "engine/cuda/warp_signs.hpp"
#include "lattice/tables/tables.hpp"

namespace meniscus::cuda {

struct TriangleRows {
    static constexpr unsigned most = 5;  ///< most triangles of a case
    static_assert(3 * most == std::tuple_size_v<decltype(CubeCase::edges)>);

    /// Row 5 case + triangle. Corner k, from bit 10 k on: the place where its edge starts (5 bits), and the axis (2).
    std::uint32_t row[cube_case_count * most];
    std::uint8_t triangles[cube_case_count];

    /// All threads of a block must call this, and wait for each other before any reads.
    __device__ void fill(const CubeCase* table) {
        static_assert(block_threads == cube_case_count);
        const unsigned i = threadIdx.x;
        const CubeCase& pattern = table[i];
        triangles[i] = pattern.triangles;
        for (unsigned t = 0; t < most; ++t) {
            std::uint32_t corners = 0;
            for (unsigned k = 0; k < 3; ++k) {
                const unsigned edge = pattern.edges[3 * t + k];
                const auto start = static_cast<unsigned>(edge_start(static_cast<int>(edge)));
                const unsigned place = ClosedPoints::place(start & 1, start >> 1 & 1, start >> 2);
                corners |= (place | (edge >> 2) << 5) << (10 * k);
            }
            row[most * i + t] = corners;
        }
    }
};

}  // namespace meniscus::cuda
