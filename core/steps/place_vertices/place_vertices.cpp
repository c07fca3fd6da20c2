// Step 6 on the CPU: the vertices of a block side by side in lanes.
#include "steps/place_vertices/place_vertices.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "engine/cpu/words.hpp"
#include "engine/index_limit.hpp"
#include "field/lanes.hpp"
#include "neighbors/cpu/block_points.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// The values of a block's sampled points by point, unpacked where not all points are sampled.
class UnpackedValues {
public:
    void read(const BlocksView& blocks, std::uint32_t block) {
        of_ = room_;
        if (block == no_index) {
            std::fill(std::begin(room_), std::end(room_), 0.0F);
        } else if (blocks.sampled[block] == ~BlockMask{0}) {
            of_ = blocks.samples + blocks.first_sample[block];
            // Clusters walk along four rows of blocks: what the next one needs of this row comes next but one.
            for (int line = 0; line < 64; line += 16) __builtin_prefetch(of_ + 128 + line);
        } else {
            const float* next = blocks.samples + blocks.first_sample[block];
            for (BlockMask left = blocks.sampled[block]; left != 0; left &= left - 1) room_[lowest_bit(left)] = *next++;
        }
    }
    float operator()(int bit) const { return of_[bit]; }

private:
    const float* of_ = nullptr;
    float room_[64];
};

/// The vertices of one block, in the order of their numbers. Arrays have room for whole lanes.
struct BlockVertices {
    std::size_t count = 0;
    std::size_t first[4];                                 ///< of every axis, and one past the last
    std::uint8_t bit[max_points];                         ///< lower end of the edge
    alignas(64) float low[max_points], high[max_points];  ///< field values at the edge's ends
    alignas(64) float offset[max_points];                 ///< in steps of c / 2^bits
};

void find_vertices(const BlocksView& blocks, std::uint32_t block, BlockVertices& vertices) {
    UnpackedValues own, next;
    own.read(blocks, block);
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        vertices.first[axis] = count;
        const BlockMask edges = blocks.edges[block].axis[axis];
        const BlockMask high_face = low_face(axis) << (3 * bit_step(axis));
        if ((edges & high_face) != 0) next.read(blocks, blocks.neighbor(block, axis_offset(axis)));
        // Which of the two blocks holds an edge's upper end is as good as random: chosen without a branch.
        const UnpackedValues* const above[2] = {&own, &next};
        const int step[2] = {bit_step(axis), -3 * bit_step(axis)};
        for (BlockMask left = edges; left != 0; left &= left - 1, ++count) {
            const int bit = lowest_bit(left);
            const auto beyond = static_cast<std::size_t>(high_face >> bit & 1);
            vertices.bit[count] = static_cast<std::uint8_t>(bit);
            vertices.low[count] = own(bit);
            vertices.high[count] = (*above[beyond])(bit + step[beyond]);
        }
    }
    vertices.first[3] = vertices.count = count;
    for (std::size_t i = count; i % WideLanes::count != 0; ++i) {
        vertices.low[i] = 0.0F;
        vertices.high[i] = 1.0F;
    }
}

bool is_low_inside(const BlocksView& blocks, std::uint32_t block, const BlockVertices& vertices, std::size_t i) {
    return (blocks.inside[block] >> vertices.bit[i] & 1) != 0;
}

void interpolate(const BlocksView& blocks, std::uint32_t block, const LatticeSettings& settings,
                 BlockVertices& vertices) {
    const int bits = static_cast<int>(settings.offset_bits);
    for (std::size_t i = 0; i < vertices.count; i += WideLanes::count)
        interpolated_offset(WideLanes::load(vertices.low + i), WideLanes::load(vertices.high + i), settings.iso, bits)
            .store(vertices.offset + i);
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

/// Normals and attributes of a cluster's vertices: most blocks have too few of them to fill registers, and neighbors
/// share the particles near them.
class ClusterSums {
public:
    ClusterSums(const BlocksView& blocks, const LatticeSettings& settings, const AttributeNumbers& numbers,
                FieldSource& field, Mesh& mesh, unsigned worker)
        : blocks_(blocks), settings_(settings), numbers_(numbers), field_(field), mesh_(mesh), worker_(worker) {}

    /// lowest: base cell of the cluster.
    void begin(const Int3& lowest) { lowest_ = lowest; }

    /// points: those of a block's vertices, relative to the block's corner.
    void add(std::uint32_t block, const PointList& points) {
        if (!settings_.has_normals && numbers_.shape.groups() == 0) return;
        if (points_.count + points.count > max_points) finish();
        const Int3 step = blocks_.coordinate(block) - lowest_;
        const float x = static_cast<float>(step.x) * base_edge, y = static_cast<float>(step.y) * base_edge,
                    z = static_cast<float>(step.z) * base_edge;
        members_[member_count_++] = {block, points_.count, points.count};
        for (std::size_t i = 0; i < points.count; ++i) {
            points_.x[points_.count + i] = points.x[i] + x;
            points_.y[points_.count + i] = points.y[i] + y;
            points_.z[points_.count + i] = points.z[i] + z;
        }
        points_.count += points.count;
    }

    /// Writes those of all blocks added.
    void finish() {
        if (member_count_ == 0) return;
        const NormalRows normals{x_, y_, z_};
        const NormalRows* to_find = settings_.has_normals ? &normals : nullptr;
        for (unsigned group = 0; group < numbers_.shape.groups(); ++group) {
            // Means are found on the way to normals: both look at all particles near, and share their distances.
            const NormalRows* const on_the_way = numbers_.shape.are_ids(group) ? nullptr : to_find;
            const std::size_t lonely =
                field_.attributes(lowest_, points_, numbers_, group, on_the_way, values_, worker_);
            if (group == 0) without_particles_ += lonely;
            if (on_the_way != nullptr) to_find = nullptr;
            for (std::size_t m = 0; m < member_count_; ++m) write_values(members_[m], group);
        }
        if (to_find != nullptr) field_.normals(lowest_, points_, normals, worker_);
        for (std::size_t m = 0; settings_.has_normals && m < member_count_; ++m) write_normals(members_[m]);
        member_count_ = 0;
        points_.count = 0;
    }

    /// Vertices that no particle is near.
    std::uint64_t without_particles() const { return without_particles_; }

private:
    struct Member {
        std::uint32_t block;
        std::size_t first, count;  ///< of its points
    };

    void write_values(const Member& member, unsigned group) {
        for (unsigned k = 0; k < numbers_.shape.count(group); ++k) {
            const AttributeNumber& number = numbers_.group(group)[k];
            number.write(mesh_.attributes[number.array].data.data(), blocks_.first_vertex[member.block],
                         values_.of[k] + member.first, static_cast<std::uint32_t>(member.count));
        }
    }

    /// The field's normals, or along the edge where the domain's border or a vanishing gradient leaves none.
    void write_normals(const Member& member) {
        Normal* const out = mesh_.normals.data() + blocks_.first_vertex[member.block];
        float sum = 0.0F;
        for (std::size_t i = 0; i < member.count; ++i) {
            const std::size_t at = member.first + i;
            out[i] = {x_[at], y_[at], z_[at]};
            sum += x_[at] + y_[at] + z_[at];
        }
        if (std::isfinite(sum) && !settings_.has_domain) return;
        BlockVertices vertices;
        find_vertices(blocks_, member.block, vertices);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = vertices.first[axis]; i < vertices.first[axis + 1]; ++i) {
                const bool is_cropped =
                    settings_.has_domain && EdgeValues{vertices.low[i], vertices.high[i]}.cropped(settings_.iso);
                out[i] = outward_normal(out[i], is_cropped, static_cast<int>(axis),
                                        is_low_inside(blocks_, member.block, vertices, i));
            }
    }

    const BlocksView& blocks_;
    const LatticeSettings& settings_;
    const AttributeNumbers& numbers_;
    FieldSource& field_;
    Mesh& mesh_;
    std::size_t member_count_ = 0;
    std::uint64_t without_particles_ = 0;
    Int3 lowest_{};
    unsigned worker_;
    Member members_[cluster_blocks];
    PointList points_;
    alignas(64) float x_[max_points];
    alignas(64) float y_[max_points];
    alignas(64) float z_[max_points];
    GroupValues values_;
};

void write_positions(const Int3& at, int bits, const PointList& points, LatticePosition* out) {
    for (std::size_t i = 0; i < points.count; ++i)
        out[i] = lattice_position(at, bits, points.x[i], points.y[i], points.z[i]);
}

/// Chooses the blocks with vertices.
void number_vertices(State& s, Mesh& mesh) {
    const BlocksView blocks = s.blocks();
    const LevelSets levels = s.level_sets();
    const SignSets signs = s.sign_sets();
    const CellSetView chosen = s.chosen_cells();
    resize_for_overwrite(s.brick_counts, s.grid.bricks.size());
    for_each_brick(s, [&](std::uint32_t brick) {
        std::uint64_t in_brick = 0;
        for_each_word(s.grid.bricks[brick], [&](int w) {
            const LevelSetsAround around(levels, brick, w);
            const std::uint64_t all = around.with_corner_points() & s.grid.bricks[brick].occupied[w];
            const std::uint64_t crossed = all == 0 ? 0 : all & signs.blocks_seeing_both(brick, w);
            for_each_cell(s.grid.bricks[brick], w, all & ~crossed,
                          [&](std::uint32_t block, int) { s.edges[block] = {}; });
            std::uint64_t with_vertices = 0;
            for_each_cell(s.grid.bricks[brick], w, crossed, [&](std::uint32_t block, int bit) {
                const LevelsAround here = around(bit);
                for (int axis = 0; axis < 3; ++axis)
                    s.edges[block].axis[axis] = CrossedEdges(blocks, block, here, axis).finest();
                const int count = s.edges[block].count();
                in_brick += static_cast<std::uint64_t>(count);
                with_vertices |= std::uint64_t{count != 0} << bit;
            });
            chosen.word(brick, w) = with_vertices;
        });
        s.brick_counts[brick] = in_brick;
    });
    const std::uint64_t count = counts_to_starts(s.brick_counts);
    for_each_brick(s, [&](std::uint32_t brick) {
        std::uint64_t next = s.brick_counts[brick];
        for_each_word(s.grid.bricks[brick], [&](int w) {
            for_each_cell(s.grid.bricks[brick], w, chosen.word(brick, w), [&](std::uint32_t block, int) {
                s.first_vertex[block] = static_cast<std::uint32_t>(next);
                next += static_cast<std::uint64_t>(s.edges[block].count());
            });
        });
    });
    require_indexable(count, "the surface has", "vertices");
    resize_for_overwrite(mesh.vertices, count);
    resize_for_overwrite(mesh.normals, s.settings.has_normals ? count : 0);
    for (MeshAttribute& attribute : mesh.attributes)
        resize_for_overwrite(attribute.data, count * attribute.element_bytes());
}

}  // namespace

void place_vertices(State& s, FieldSource& field, Mesh& mesh) {
    number_vertices(s, mesh);
    const BlocksView blocks = s.blocks();
    std::atomic<std::uint64_t> evaluations{0}, without_particles{0};
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        BlockVertices vertices;
        PointList points;
        ClusterSums sums(blocks, s.settings, s.attributes, field, mesh, worker);
        const auto place_block = [&](std::uint32_t block) {
            find_vertices(blocks, block, vertices);
            const Int3 at = blocks.coordinate(block);
            if (s.settings.bisects) {
                bisect(field, at, blocks, block, s.settings, worker, vertices);
                evaluations.fetch_add(vertices.count * s.settings.bisection_steps, std::memory_order_relaxed);
            } else {
                interpolate(blocks, block, s.settings, vertices);
            }
            list_points(vertices, s.settings.offset_bits, points);
            write_positions(at, static_cast<int>(s.settings.offset_bits), points,
                            mesh.vertices.data() + s.first_vertex[block]);
            sums.add(block, points);
        };
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            const std::uint64_t* const chosen = &s.chosen_cells().word(static_cast<std::uint32_t>(b), 0);
            for_each_cluster(chosen, [&](const Int3& corner) {
                sums.begin(brick.corner() + corner);
                for_each_member(brick, chosen, corner, place_block);
                sums.finish();
            });
        }
        without_particles.fetch_add(sums.without_particles(), std::memory_order_relaxed);
    });
    s.vertices_without_particles = without_particles.load(std::memory_order_relaxed);
    s.field_evaluations += evaluations.load(std::memory_order_relaxed);
}

}  // namespace meniscus::cpu
