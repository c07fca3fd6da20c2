// Curvature at a point of the surface in every cell of the band, the cells of a cluster at once.
#include <algorithm>
#include <atomic>

#include "field/kernels.hpp"
#include "field/sums.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "neighbors/cpu/point_sums.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/split_cells/curvature.hpp"
#include "steps/split_cells/split_cells.hpp"

namespace meniscus::cpu {
namespace {

/// The search meets points that are no whole units, and how they are rounded depends on how far their origin is. So it
/// is the lowest corner of their pair of cells a side, whatever the number of lanes.
constexpr int cells_of_origin = 2;
static_assert(cluster_size.y == cells_of_origin && cluster_size.z == cells_of_origin);

/// Coordinates x of points from that corner.
template <class F>
struct FromPair {
    F x;
    F aside;  ///< shift from the origin of the neighbors to that of the points: exact, in whole units

    friend F operator-(const FromPair& p, const F& neighbor) { return p.x - (neighbor - p.aside); }
};

/// The base vertices at the corners of a cluster's cells: by x, then y, then z.
struct ClusterVertices {
    static constexpr int row = cluster_size.x + 1;
    static constexpr int count = 9 * row;
    float value[count];        ///< zero where no block is stored
    std::uint64_t inside = 0;  ///< signs as bits

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

/// Some cells of a cluster, lane by lane, in which the surface is looked for.
class SearchedCells {
public:
    int count() const { return count_; }

    /// step: the cell's place in the cluster.
    void add(std::uint32_t block, const Int3& step, const ClusterVertices& vertices, float iso) {
        int inside_corners = 0;
        for (int k = 0; k < 8; ++k) {
            const int vertex =
                step.x + (k & 1) + ClusterVertices::row * (step.y + (k >> 1 & 1) + 3 * (step.z + (k >> 2)));
            corners_[k][count_] = vertices.value[vertex] - iso;
            inside_corners += static_cast<int>(vertices.inside >> vertex & 1);
        }
        block_[count_] = block;
        inside_corners_[count_] = inside_corners;
        mixed_[count_] = is_mixed(inside_corners) ? 1.0F : 0.0F;
        lowest_[0][count_] = static_cast<float>(step.x % cells_of_origin) * base_edge;
        lowest_[1][count_] = static_cast<float>(step.y) * base_edge;
        lowest_[2][count_] = static_cast<float>(step.z) * base_edge;
        aside_[count_] = static_cast<float>(step.x) * base_edge - lowest_[0][count_];
        ++count_;
    }

    /// Searches by a register of lanes F, enough for all cells. near(box): the neighbors of a box.
    template <class Kernel, class F, class Near>
    void search(float iso, const Near& near) {
        // Lanes beyond the last cell repeat the first, so that the box around their points stays small.
        for (float* const row : {corners_[0], corners_[1], corners_[2], corners_[3], corners_[4], corners_[5],
                                 corners_[6], corners_[7], mixed_, lowest_[0], lowest_[1], lowest_[2], aside_})
            std::fill(row + count_, row + F::count, row[0]);
        const F aside = F::load(aside_);
        const auto jet_at = [&](const Point3<F>& p) {
            FieldJet<F> jet;
            const auto add_near = [&](const UnitBox& box, const auto& x) {
                for (const NeighborList& of_level : near(box)) sum_jets<Kernel>(of_level.view(), x, p.y, p.z, jet);
            };
            // A box that is rounded makes no difference: neighbors from a little farther than they reach.
            if constexpr (cluster_size.x == cells_of_origin)
                add_near(box_of_lanes(p.x, p.y, p.z), p.x);
            else
                add_near(box_of_lanes(p.x + aside, p.y, p.z), FromPair<F>{p.x, aside});
            return jet;
        };
        CellCorners<F> values;
        for (int k = 0; k < 8; ++k) values.value[k] = F::load(corners_[k]);
        const Point3<F> lowest{F::load(lowest_[0]), F::load(lowest_[1]), F::load(lowest_[2])};
        const SurfaceSearch<F> found =
            search_surface(values, F::load(mixed_), lowest, iso, jet_at,
                           [](const F& of_cells) { return less_equal(F(1.0F), of_cells) != 0; });
        found.bend.curvature.store(curvature_);
        found.bend.trace.store(trace_);
        found.inside.store(inside_);
        found.again.store(again_);
    }

    /// The number of points at which the field was evaluated.
    std::uint64_t evaluations() const {
        std::uint64_t looks = static_cast<std::uint64_t>(count_);
        for (int i = 0; i < count_; ++i) looks += again_[i] == 1.0F ? 1 : 0;
        return looks;
    }

    void enter_bends(State& state, const BlobRule& blobs) const {
        for (int i = 0; i < count_; ++i)
            state.bends[block_[i]] = cell_bend({{curvature_[i], trace_[i]}, inside_[i], again_[i]}, inside_corners_[i],
                                               blobs.least_level(inside_corners_[i], state.reaches[block_[i]]));
    }

private:
    alignas(64) float corners_[8][cluster_blocks];  ///< corner values less the iso-value
    alignas(64) float mixed_[cluster_blocks];       ///< 1 where the corners' signs are mixed, else 0
    alignas(64) float lowest_[3][cluster_blocks];   ///< lowest points, units from their pair's
    alignas(64) float aside_[cluster_blocks];       ///< distance of the pair along x from the cluster's lowest point
    alignas(64) float curvature_[cluster_blocks];
    alignas(64) float trace_[cluster_blocks];
    alignas(64) float inside_[cluster_blocks];
    alignas(64) float again_[cluster_blocks];
    std::uint32_t block_[cluster_blocks];
    int inside_corners_[cluster_blocks];
    int count_ = 0;
};

/// Finds the bends of the chosen cells.
template <class Kernel>
void measure(State& state, NeighborSearch& search) {
    state.bends.assign(state.block_count(), {0.0F, 0.0F, 1});
    const BlocksView blocks = state.blocks();
    const BlobRule blobs{state.settings.blob_closest, state.settings.blob_level};
    const float iso = state.settings.iso;
    std::atomic<std::uint64_t> evaluations{0};
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        std::uint64_t here = 0;
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = state.grid.bricks[b];
            const std::uint64_t* const chosen = &state.chosen_cells().word(static_cast<std::uint32_t>(b), 0);
            for_each_cluster(chosen, [&](const Int3& corner) {
                const ClusterVertices vertices(blocks, static_cast<std::uint32_t>(b), corner);
                SearchedCells cells;
                for (int i = 0; i < cluster_blocks; ++i) {
                    const Int3 step = cluster_step(i);
                    const int place = index_in_brick(corner + step);
                    if ((chosen[place >> 6] >> (place & 63) & 1) != 0)
                        cells.add(brick.number(place), step, vertices, iso);
                }
                const auto near_box = [&](const UnitBox& box) -> const NeighborLists::Levels& {
                    return search.near_box(brick.corner() + corner, box, worker);
                };
                // A sheet of cells fills half of a wide register.
                with_lanes_for(cells.count(), [&]<class F>() { cells.search<Kernel, F>(iso, near_box); });
                cells.enter_bends(state, blobs);
                here += cells.evaluations();
            });
        }
        evaluations.fetch_add(here, std::memory_order_relaxed);
    });
    state.field_evaluations += evaluations.load(std::memory_order_relaxed);
    search.even_out();
}

}  // namespace

void measure_bends(State& state, NeighborSearch& search) {
    with_kernel(state.settings, [&]<class Kernel>() { measure<Kernel>(state, search); });
}

}  // namespace meniscus::cpu
