// Step 6 on the CPU: the vertices of a block side by side in lanes.
#include "steps/place_vertices/place_vertices.hpp"

#include <atomic>

#include "engine/cpu/words.hpp"
#include "engine/index_limit.hpp"
#include "field/lanes.hpp"
#include "neighbors/cpu/block_points.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/place_vertices/block_vertices.hpp"
#include "steps/place_vertices/cluster_sums.hpp"
#include "steps/place_vertices/coarse_edges.hpp"

namespace meniscus::cpu {
namespace {

/// Finds the iso-values that a block's vertices take.
void find_iso_values(const BlocksView& blocks, std::uint32_t block, const State& state, BlockVertices& vertices) {
    const float iso = state.settings.iso;
    CellAtEdge cells[8];
    unsigned looked_up = 0;
    const auto cell_at = [&](int i) {
        if ((looked_up >> i & 1) == 0) {
            const std::uint32_t cell = i == 0 ? block : blocks.neighbor(block, LevelsAround::offset(i));
            cells[i] = CellAtEdge(blocks, state.bends.data(), cell);
            looked_up |= 1U << i;
        }
        return cells[i];
    };
    for (int axis = 0; axis < 3; ++axis) {
        const BlockMask low_u = low_face(lateral_u(axis));
        const BlockMask low_v = low_face(lateral_v(axis));
        // All edges along an axis that lie on the same low faces have the same cells.
        float shifted[4];
        unsigned known = 0;
        for (std::size_t i = vertices.first[axis]; i < vertices.first[axis + 1]; ++i) {
            const int bit = vertices.bit[i];
            const auto faces = static_cast<unsigned>((low_u >> bit & 1) | (low_v >> bit & 1) << 1);
            if ((known >> faces & 1) == 0) shifted[faces] = iso + iso_shift(axis, bit, cell_at);
            known |= 1U << faces;
            vertices.iso[i] = shifted[faces];
        }
    }
}

void interpolate(const BlocksView& blocks, std::uint32_t block, const State& state, BlockVertices& vertices) {
    const LatticeSettings& settings = state.settings;
    const int bits = static_cast<int>(settings.offset_bits);
    const auto place = [&](const auto& iso_at) {
        for (std::size_t i = 0; i < vertices.count; i += WideLanes::count)
            interpolated_offset(WideLanes::load(vertices.low + i), WideLanes::load(vertices.high + i), iso_at(i), bits)
                .store(vertices.offset + i);
    };
    if (settings.moves_coarse_vertices() && blocks.level[block] != 3) {
        find_iso_values(blocks, block, state, vertices);
        place([&](std::size_t i) { return WideLanes::load(vertices.iso + i); });
    } else {
        place([&](std::size_t) { return WideLanes(settings.iso); });
    }
    if (!settings.has_domain) return;
    for (std::size_t i = 0; i < vertices.count; ++i)
        if (EdgeValues{vertices.low[i], vertices.high[i]}.cropped(settings.iso))
            vertices.offset[i] = cropped_offset(is_low_inside(blocks, block, vertices, i), bits);
}

/// Points in units, at the vertices' offsets in steps of c / 2^bits.
void list_points(const BlockVertices& vertices, std::uint32_t bits, PointList& points) {
    const auto step = static_cast<float>(units_per_cell >> bits);
    for (std::size_t i = 0; i < vertices.count; ++i) {
        points.x[i] = block_points.coordinate[0][vertices.bit[i]];
        points.y[i] = block_points.coordinate[1][vertices.bit[i]];
        points.z[i] = block_points.coordinate[2][vertices.bit[i]];
    }
    float* const coordinates[3] = {points.x, points.y, points.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = vertices.first[axis]; i < vertices.first[axis + 1]; ++i)
            coordinates[axis][i] += vertices.offset[i] * step;
    points.count = vertices.count;
}

void bisect(FieldSource& field, const Int3& at, const BlocksView& blocks, std::uint32_t block,
            const LatticeSettings& settings, unsigned worker, BlockVertices& vertices) {
    PointList points;
    alignas(64) float values[max_points];
    const int bits = static_cast<int>(settings.offset_bits);
    for (std::size_t i = 0; i < vertices.count; ++i) vertices.offset[i] = bisection_start(bits);
    for (int step = first_bisection_step(bits); step >= 1; step /= 2) {
        list_points(vertices, settings.offset_bits, points);
        field.values(at, points, values, worker);
        for (std::size_t i = 0; i < vertices.count; ++i) {
            vertices.offset[i] = bisected_offset(vertices.offset[i], step, values[i] > settings.iso,
                                                 is_low_inside(blocks, block, vertices, i));
        }
    }
}

void write_positions(const Int3& at, int bits, const PointList& points, LatticePosition* out) {
    for (std::size_t i = 0; i < points.count; ++i)
        out[i] = lattice_position(at, bits, points.x[i], points.y[i], points.z[i]);
}

/// Chooses the blocks with vertices.
void number_vertices(State& state, Mesh& mesh) {
    const BlocksView blocks = state.blocks();
    const LevelSets levels = state.level_sets();
    const SignSets signs = state.sign_sets();
    const CellSetView chosen = state.chosen_cells();
    resize_for_overwrite(state.brick_counts, state.grid.bricks.size());
    for_each_brick(state, [&](std::uint32_t brick) {
        std::uint64_t in_brick = 0;
        for_each_word(state.grid.bricks[brick], [&](int w) {
            const LevelSetsAround around(levels, brick, w);
            const std::uint64_t all = around.with_corner_points() & state.grid.bricks[brick].occupied[w];
            const std::uint64_t crossed = all == 0 ? 0 : all & signs.blocks_seeing_both(brick, w);
            for_each_cell(state.grid.bricks[brick], w, all & ~crossed,
                          [&](std::uint32_t block, int) { state.edges[block] = {}; });
            std::uint64_t with_vertices = 0;
            for_each_cell(state.grid.bricks[brick], w, crossed, [&](std::uint32_t block, int bit) {
                const LevelsAround here = around(bit);
                for (int axis = 0; axis < 3; ++axis)
                    state.edges[block].axis[axis] = CrossedEdges(blocks, block, here, axis).finest();
                const int count = state.edges[block].count();
                in_brick += static_cast<std::uint64_t>(count);
                with_vertices |= std::uint64_t{count != 0} << bit;
            });
            chosen.word(brick, w) = with_vertices;
        });
        state.brick_counts[brick] = in_brick;
    });
    const std::uint64_t count = counts_to_starts(state.brick_counts);
    for_each_brick(state, [&](std::uint32_t brick) {
        std::uint64_t next = state.brick_counts[brick];
        for_each_word(state.grid.bricks[brick], [&](int w) {
            for_each_cell(state.grid.bricks[brick], w, chosen.word(brick, w), [&](std::uint32_t block, int) {
                state.first_vertex[block] = static_cast<std::uint32_t>(next);
                next += static_cast<std::uint64_t>(state.edges[block].count());
            });
        });
    });
    require_indexable(count, "the surface has", "vertices");
    resize_for_overwrite(mesh.vertices, count);
    resize_for_overwrite(mesh.normals, state.settings.has_normals ? count : 0);
    for (MeshAttribute& attribute : mesh.attributes)
        resize_for_overwrite(attribute.data, count * attribute.element_bytes());
}

}  // namespace

void place_vertices(State& state, FieldSource& field, Mesh& mesh) {
    number_vertices(state, mesh);
    const BlocksView blocks = state.blocks();
    std::atomic<std::uint64_t> evaluations{0}, without_particles{0};
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        BlockVertices vertices;
        PointList points;
        ClusterSums sums(blocks, state.settings, state.attributes, field, mesh, worker);
        const auto place_block = [&](std::uint32_t block) {
            find_vertices(blocks, block, vertices);
            const Int3 at = blocks.coordinate(block);
            if (state.settings.bisects) {
                bisect(field, at, blocks, block, state.settings, worker, vertices);
                evaluations.fetch_add(vertices.count * state.settings.bisection_steps, std::memory_order_relaxed);
            } else {
                interpolate(blocks, block, state, vertices);
            }
            list_points(vertices, state.settings.offset_bits, points);
            write_positions(at, static_cast<int>(state.settings.offset_bits), points,
                            mesh.vertices.data() + state.first_vertex[block]);
            sums.add(block, points);
        };
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = state.grid.bricks[b];
            const std::uint64_t* const chosen = &state.chosen_cells().word(static_cast<std::uint32_t>(b), 0);
            for_each_cluster(chosen, [&](const Int3& corner) {
                sums.begin(brick.corner() + corner);
                for_each_member(brick, chosen, corner, place_block);
                sums.finish();
            });
        }
        without_particles.fetch_add(sums.without_particles(), std::memory_order_relaxed);
    });
    state.vertices_without_particles = without_particles.load(std::memory_order_relaxed);
    state.field_evaluations += evaluations.load(std::memory_order_relaxed);
}

}  // namespace meniscus::cpu
