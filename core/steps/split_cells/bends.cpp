// Curvature at a point of the surface in every cell of the band, the cells of a cluster at once.
#include <atomic>

#include "engine/cpu/clusters.hpp"
#include "field/kernels.hpp"
#include "field/sums.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/split_cells/curvature.hpp"
#include "steps/split_cells/split_cells.hpp"

namespace meniscus::cpu {
namespace {

/// The smallest box around points.
UnitBox box_of(const Point3<WideLanes>& points) {
    return {{reduce_min(points.x), reduce_min(points.y), reduce_min(points.z)},
            {reduce_max(points.x), reduce_max(points.y), reduce_max(points.z)}};
}

template <class Kernel>
void measure(State& s, Neighborhoods& near) {
    resize_for_overwrite(s.bends, s.block_count());
    const BlocksView blocks = s.blocks();
    const BlobRule blobs{s.settings.blob_closest, s.settings.blob_level};
    const float iso = s.settings.iso;
    std::atomic<std::uint64_t> evaluations{0};
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            for_each_cluster(brick.occupied, [&](const Int3& corner) {
                std::uint32_t block[cluster_blocks];
                std::uint64_t cells = 0;
                int first = 0;
                for (int i = 0; i < cluster_blocks; ++i) {
                    const int place = index_in_brick(corner + cluster_step(i));
                    block[i] = brick.holds(place) ? brick.number(place) : no_index;
                    if (block[i] != no_index) s.bends[block[i]] = {0.0F, 1};
                    const bool in_band = blocks.level_or_none(block[i]) != 0;
                    if (in_band && cells++ == 0) first = i;
                    if (!in_band) block[i] = no_index;
                }
                if (cells == 0) return;
                // The cells share their corners: by x, then y, then z.
                constexpr int row = cluster_size.x + 1;
                constexpr int vertex_count = 9 * row;
                float vertices[vertex_count];
                std::uint64_t inside_vertices = 0;
                for (int i = 0; i < vertex_count; ++i) {
                    const std::uint32_t owner = blocks.grid.neighbor(
                        static_cast<std::uint32_t>(b), index_in_brick(corner), {i % row, i / row % 3, i / row / 3});
                    vertices[i] = (owner == no_index ? 0.0F : blocks.value(owner, 0)) - iso;
                    inside_vertices |= (blocks.inside_or_none(owner) & 1) << i;
                }
                alignas(64) float corners[8][cluster_blocks], starts[3][cluster_blocks],
                    mixed[cluster_blocks];  // [corner][cell]
                int inside_corners[cluster_blocks];
                for (int i = 0; i < cluster_blocks; ++i) {
                    // Lanes of cells outside the band repeat another's, so that the box around their points stays
                    // small.
                    const Int3 step = cluster_step(block[i] != no_index ? i : first);
                    inside_corners[i] = 0;
                    for (int k = 0; k < 8; ++k) {
                        const int vertex = step.x + (k & 1) + row * (step.y + (k >> 1 & 1) + 3 * (step.z + (k >> 2)));
                        corners[k][i] = vertices[vertex];
                        inside_corners[i] += static_cast<int>(inside_vertices >> vertex & 1);
                    }
                    mixed[i] = is_mixed(inside_corners[i]) ? 1.0F : 0.0F;
                    starts[0][i] = static_cast<float>(step.x) * base_edge;
                    starts[1][i] = static_cast<float>(step.y) * base_edge;
                    starts[2][i] = static_cast<float>(step.z) * base_edge;
                }
                evaluations.fetch_add(2 * cells, std::memory_order_relaxed);
                const Int3 base = brick.corner() + corner;
                const auto jet_at = [&]<class Jet>(const Point3<WideLanes>& p, Jet jet) {
                    for (const Candidates& c : near.near_box(base, box_of(p), worker))
                        sum_jets<Kernel>(c.view(), p.x, p.y, p.z, jet);
                    return jet;
                };
                CellCorners<WideLanes> values;
                for (int k = 0; k < 8; ++k) values.value[k] = WideLanes::load(corners[k]);
                const Point3<WideLanes> origin{WideLanes::load(starts[0]), WideLanes::load(starts[1]),
                                               WideLanes::load(starts[2])};
                const SurfaceSearch<WideLanes> search =
                    search_surface(values, WideLanes::load(mixed), origin, iso, jet_at);
                alignas(64) float curvature[cluster_blocks], inside[cluster_blocks];
                search.curvature.store(curvature);
                search.inside.store(inside);
                for (int i = 0; i < cluster_blocks; ++i) {
                    if (block[i] == no_index) continue;
                    s.bends[block[i]] = cell_bend({curvature[i], inside[i]}, inside_corners[i],
                                                  blobs.least_level(inside_corners[i], s.reaches[block[i]]));
                }
            });
        }
    });
    s.field_evaluations += evaluations.load(std::memory_order_relaxed);
    near.even_out();
}

}  // namespace

void measure_bends(State& s, Neighborhoods& near) {
    with_kernel(s.settings, [&]<class Kernel>() { measure<Kernel>(s, near); });
}

}  // namespace meniscus::cpu
