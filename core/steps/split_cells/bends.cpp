// Curvature at a point of the surface in every cell of the band, the cells of a cluster at once.
#include <algorithm>
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

/// The search meets points that are no whole units, and how they are rounded depends on how far their origin is. So it
/// is the lowest corner of their pair of cells a side, whatever the number of lanes.
constexpr int cells_of_origin = 2;
static_assert(cluster_size.y == cells_of_origin && cluster_size.z == cells_of_origin);

/// Coordinates x of points from there.
struct FromPair {
    WideLanes x;
    WideLanes aside;  ///< from the origin of the candidates to that of the points: whole units, so that this is exact

    friend WideLanes operator-(const FromPair& p, const WideLanes& candidate) { return p.x - (candidate - p.aside); }
};

/// The base vertices at the corners of a cluster's cells: by x, then y, then z.
struct ClusterVertices {
    static constexpr int row = cluster_size.x + 1;
    static constexpr int count = 9 * row;
    float value[count];        ///< zero where no block is stored
    std::uint64_t inside = 0;  ///< as bits

    /// corner: lowest cell of the cluster, in this brick.
    ClusterVertices(const BlocksView& blocks, std::uint32_t brick, const Int3& corner) {
        for (int i = 0; i < 9; ++i) {
            const Int3 to = corner + Int3{0, i % 3, i / 3};
            const Int3 beyond = brick_of(to);
            read(blocks, blocks.grid.neighbors[brick].brick[neighbor_slot(0, beyond.y, beyond.z)], to, cluster_size.x,
                 row * i);
            const int last = corner.x + cluster_size.x;
            read(blocks,
                 blocks.grid.neighbors[brick].brick[neighbor_slot(last >> brick_axis_shift, beyond.y, beyond.z)],
                 {last, to.y, to.z}, 1, row * i + cluster_size.x);
        }
    }

private:
    /// Some vertices in a row of one brick, from a place on. A block's first sample is that of its base vertex.
    void read(const BlocksView& blocks, std::uint32_t brick, const Int3& place, int vertices, int at) {
        if (brick == no_index) {
            std::fill(value + at, value + at + vertices, 0.0F);
            return;
        }
        const int index = index_in_brick(place);
        const std::uint64_t members = blocks.grid.bricks[brick].occupied[index >> 6] >> (index & 63);
        std::uint32_t block = blocks.grid.bricks[brick].number(index);
        for (int i = 0; i < vertices; ++i) {
            const bool is_stored = (members >> i & 1) != 0;
            value[at + i] = is_stored ? blocks.samples[blocks.first_sample[block]] : 0.0F;
            inside |= std::uint64_t{is_stored && (blocks.inside[block] & 1) != 0} << (at + i);
            block += is_stored ? 1 : 0;
        }
    }
};

/// Of the chosen cells.
template <class Kernel>
void measure(State& s, Neighborhoods& near) {
    s.bends.assign(s.block_count(), {0.0F, 1});
    const BlocksView blocks = s.blocks();
    const BlobRule blobs{s.settings.blob_closest, s.settings.blob_level};
    const float iso = s.settings.iso;
    std::atomic<std::uint64_t> evaluations{0};
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        std::uint64_t here = 0;
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            const std::uint64_t* const chosen = &s.chosen_cells().word(static_cast<std::uint32_t>(b), 0);
            for_each_cluster(chosen, [&](const Int3& corner) {
                std::uint32_t block[cluster_blocks];
                int first = cluster_blocks;
                for (int i = 0; i < cluster_blocks; ++i) {
                    const int place = index_in_brick(corner + cluster_step(i));
                    const bool is_chosen = (chosen[place >> 6] >> (place & 63) & 1) != 0;
                    block[i] = is_chosen ? brick.number(place) : no_index;
                    first = is_chosen ? std::min(first, i) : first;
                    here += is_chosen ? 2 : 0;
                }
                const ClusterVertices vertices(blocks, static_cast<std::uint32_t>(b), corner);
                alignas(64) float corners[8][cluster_blocks], starts[3][cluster_blocks], asides[cluster_blocks],
                    mixed[cluster_blocks];  // [corner][cell]
                int inside_corners[cluster_blocks];
                for (int i = 0; i < cluster_blocks; ++i) {
                    // Lanes of cells that are not chosen repeat another's, so that the box around their points stays
                    // small.
                    const Int3 step = cluster_step(block[i] != no_index ? i : first);
                    inside_corners[i] = 0;
                    for (int k = 0; k < 8; ++k) {
                        const int vertex =
                            step.x + (k & 1) + ClusterVertices::row * (step.y + (k >> 1 & 1) + 3 * (step.z + (k >> 2)));
                        corners[k][i] = vertices.value[vertex] - iso;
                        inside_corners[i] += static_cast<int>(vertices.inside >> vertex & 1);
                    }
                    mixed[i] = is_mixed(inside_corners[i]) ? 1.0F : 0.0F;
                    starts[0][i] = static_cast<float>(step.x % cells_of_origin) * base_edge;
                    asides[i] = static_cast<float>(step.x) * base_edge - starts[0][i];
                    starts[1][i] = static_cast<float>(step.y) * base_edge;
                    starts[2][i] = static_cast<float>(step.z) * base_edge;
                }
                const Int3 base = brick.corner() + corner;
                const WideLanes aside = WideLanes::load(asides);
                const auto jet_at = [&]<class Jet>(const Point3<WideLanes>& p, Jet jet) {
                    const auto add_near = [&](const UnitBox& box, const auto& x) {
                        for (const Candidates& c : near.near_box(base, box, worker))
                            sum_jets<Kernel>(c.view(), x, p.y, p.z, jet);
                    };
                    // A box that is rounded makes no difference: candidates from a little farther than they reach.
                    if constexpr (cluster_size.x == cells_of_origin)
                        add_near(box_of(p), p.x);
                    else
                        add_near(box_of({p.x + aside, p.y, p.z}), FromPair{p.x, aside});
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
        evaluations.fetch_add(here, std::memory_order_relaxed);
    });
    s.field_evaluations += evaluations.load(std::memory_order_relaxed);
    near.even_out();
}

}  // namespace

void measure_bends(State& s, Neighborhoods& near) {
    with_kernel(s.settings, [&]<class Kernel>() { measure<Kernel>(s, near); });
}

}  // namespace meniscus::cpu
