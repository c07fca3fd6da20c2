#include "stages/fill_cracks.hpp"

#include "backends/cuda/steps.hpp"
#include "backends/cuda/warp.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) fill_listed(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    constexpr int crack = static_cast<int>(TriangleLevel::crack);
    GridLoop{}.each(f.listed(List::cracks), [&](std::uint32_t i) {
        const std::uint32_t block = f.cracked[i];
        emit_crack_triangles(blocks, block, f.crack_table, f.triangles + f.counts->first_triangle[crack] + f.triangles_before[block].of[crack]);
    });
}

}  // namespace

void fill_cracks(const Frame& frame, const Launcher& launch) { launch(frame.capacity[Resource::blocks], block_threads, fill_listed, frame); }

}  // namespace meniscus::cuda
