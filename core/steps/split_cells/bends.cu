// Curvature at a point of the surface in every cell of the band, a thread for every cell.
#include "engine/cuda/candidates.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/split_cells/curvature.hpp"
#include "steps/split_cells/split_cells.hpp"

namespace meniscus::cuda {
namespace {

template <class Kernel>
__global__ void __launch_bounds__(block_threads, 2) measure_listed(const __grid_constant__ State f) {
    const BlocksView blocks = f.blocks();
    const BlobRule blobs{f.settings.blob_closest, f.settings.blob_level};
    const float iso = f.settings.iso;
    const std::uint32_t cells = f.listed(List::bends);
    LongLoop loop(f);
    GridLoop{}.each(cells, [&](std::uint32_t i) {
        if (!loop.goes_on()) return;
        const std::uint32_t block = f.chosen[i];
        const ClosedCell cell(blocks, block);
        CellCorners<float> corners;
        int inside_corners = 0;
        for (int k = 0; k < 8; ++k) {
            corners.value[k] = (cell.block[k] == no_index ? 0.0F : blocks.value(cell.block[k], 0)) - iso;
            inside_corners += static_cast<int>(blocks.inside_or_none(cell.block[k]) & 1);
        }
        // Relative to the corner of the cell's cluster, as on the CPU: the search meets points that are no whole units.
        const Int3 at = blocks.coordinate(block);
        const Int3 cluster{at.x & ~1, at.y & ~1, at.z & ~1};
        constexpr float edge = units_per_base_cell;
        const Point3<float> corner{static_cast<float>(at.x - cluster.x) * edge,
                                   static_cast<float>(at.y - cluster.y) * edge,
                                   static_cast<float>(at.z - cluster.z) * edge};
        const auto jet_at = [&]<class Jet>(const Point3<float>& p, Jet jet) {
            // Wider by a unit, since the sides of the box are rounded.
            const UnitBox box{{p.x - 1.0F, p.y - 1.0F, p.z - 1.0F}, {p.x + 1.0F, p.y + 1.0F, p.z + 1.0F}};
            for_each_candidate<Kernel>(f, base_cell_origin(cluster), box,
                                       [&](const OneCandidate& c) { sum_jets<Kernel>(c.view(), p.x, p.y, p.z, jet); });
            return jet;
        };
        const SurfaceSearch<float> search =
            search_surface(corners, is_mixed(inside_corners) ? 1.0F : 0.0F, corner, iso, jet_at);
        f.bends[block] = cell_bend(search, inside_corners, blobs.least_level(inside_corners, f.reaches[block]));
    });
    if (blockIdx.x == 0 && threadIdx.x == 0) f.counts->field_evaluations += Counter{2} * cells;
}

}  // namespace

void measure_bends(const State& state, const Launcher& launch) {
    with_kernel(state.settings, [&]<class Kernel>() {
        launch(state.capacity[Resource::blocks], block_threads, measure_listed<Kernel>, state);
    });
}

}  // namespace meniscus::cuda
