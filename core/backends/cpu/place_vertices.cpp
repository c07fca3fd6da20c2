#include "stages/place_vertices.hpp"

#include <atomic>
#include <cmath>
#include <string>

#include "backends/cpu/clusters.hpp"
#include "backends/cpu/surface.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cpu {
namespace {

/// The vertices of one block, in the order of their numbers.
struct BlockVertices {
    std::size_t count = 0;
    std::uint8_t axis[max_points];
    std::uint8_t bit[max_points];
    EdgeEnds ends[max_points];
    int offset[max_points];  ///< in steps of c / 2^bits
};

void find_vertices(const BlocksView& blocks, std::uint32_t block, BlockVertices& vertices) {
    vertices.count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t next = blocks.neighbor(block, axis_offset(axis));
        for (BlockMask left = blocks.edges[block].axis[axis]; left != 0; left &= left - 1) {
            const int bit = lowest_bit(left);
            vertices.axis[vertices.count] = static_cast<std::uint8_t>(axis);
            vertices.bit[vertices.count] = static_cast<std::uint8_t>(bit);
            vertices.ends[vertices.count] = edge_ends(blocks, block, next, axis, bit);
            ++vertices.count;
        }
    }
}

/// Points in units, at the vertices' offsets in steps of c / 2^bits.
void list_points(const BlockVertices& vertices, std::uint32_t bits, PointList& points) {
    const int step = units_per_cell >> bits;
    points.count = 0;
    for (std::size_t i = 0; i < vertices.count; ++i) {
        int p[3];
        for (int axis = 0; axis < 3; ++axis) p[axis] = point_coordinate(vertices.bit[i], axis) * units_per_cell;
        p[vertices.axis[i]] += vertices.offset[i] * step;
        points.add(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    }
}

/// The paper's bisection, on the finest edge: the halves of coarse edges have been chosen by the samples already.
void bisect(FieldSource& field, const Int3& at, const LatticeSettings& settings, unsigned worker, BlockVertices& vertices) {
    PointList points;
    alignas(32) float values[max_points];
    const int whole = 1 << settings.offset_bits;
    for (std::size_t i = 0; i < vertices.count; ++i) vertices.offset[i] = whole / 2;
    // Every step moves to the middle of the half that still has a change of sign.
    for (int half = whole / 4; half >= 1; half /= 2) {
        list_points(vertices, settings.offset_bits, points);
        field.values(at, points, values, worker);
        for (std::size_t i = 0; i < vertices.count; ++i) {
            const bool same_as_low = (values[i] > settings.iso) == vertices.ends[i].low_inside;
            vertices.offset[i] += same_as_low ? half : -half;
        }
    }
}

/// The field's normal, or along the edge where the domain's border or a vanishing gradient leaves none.
Normal outward(const EdgeEnds& ends, int axis, const Normal& of_field, float iso) {
    const float sum = of_field[0] + of_field[1] + of_field[2];
    if (std::isfinite(sum) && !ends.cropped(iso)) return of_field;
    Normal normal{0.0F, 0.0F, 0.0F};
    normal[static_cast<std::size_t>(axis)] = ends.low_inside ? 1.0F : -1.0F;
    return normal;
}

void number_vertices(Surface& s, Mesh& mesh) {
    const BlocksView blocks = s.view();
    s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            for (int axis = 0; axis < 3; ++axis)
                s.edges[b].axis[axis] = s.corner_points[b] == 0 ? 0 : CrossedEdges(blocks, static_cast<std::uint32_t>(b), axis).finest();
    });
    const std::uint64_t count = s.scan.exclusive(
        s.workers, s.block_count(), [&](std::size_t b) { return static_cast<std::uint64_t>(s.edges[b].count()); },
        [&](std::size_t b, std::uint64_t before) { s.first_vertex[b] = static_cast<std::uint32_t>(before); });
    if (count >= no_index)
        throw LimitExceeded("the surface has more than " + std::to_string(no_index) +
                            " vertices, more than can be numbered: use a larger cell size or fewer particles");
    resize_for_overwrite(mesh.vertices, count);
    resize_for_overwrite(mesh.normals, count);
}

}  // namespace

void place_vertices(Surface& s, FieldSource& field, const Settings& user, Mesh& mesh) {
    number_vertices(s, mesh);
    const BlocksView blocks = s.view();
    const auto bits = s.settings.offset_bits;
    std::atomic<std::uint64_t> evaluations{0};
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        BlockVertices vertices;
        PointList points;
        alignas(32) float nx[max_points];
        alignas(32) float ny[max_points];
        alignas(32) float nz[max_points];
        const auto place_block = [&](std::uint32_t block) {
            if (s.edges[block].count() == 0) return;
            find_vertices(blocks, block, vertices);
            const Int3 at = blocks.coordinate(block);
            if (user.edge_points == EdgePoints::bisect) {
                bisect(field, at, s.settings, worker, vertices);
                evaluations.fetch_add(vertices.count * user.bisection_steps, std::memory_order_relaxed);
            } else {
                for (std::size_t i = 0; i < vertices.count; ++i)
                    vertices.offset[i] = interpolated_offset(vertices.ends[i], s.settings.iso, static_cast<int>(bits));
            }
            list_points(vertices, bits, points);
            field.normals(at, points, nx, ny, nz, worker);
            for (std::size_t i = 0; i < vertices.count; ++i) {
                const int bit = vertices.bit[i];
                LatticePosition p{(at.x * base_cell_size + point_coordinate(bit, 0)) * (1 << bits),
                                  (at.y * base_cell_size + point_coordinate(bit, 1)) * (1 << bits),
                                  (at.z * base_cell_size + point_coordinate(bit, 2)) * (1 << bits)};
                p[vertices.axis[i]] += vertices.offset[i];
                mesh.vertices[s.first_vertex[block] + i] = p;
                mesh.normals[s.first_vertex[block] + i] =
                    outward(vertices.ends[i], vertices.axis[i], {nx[i], ny[i], nz[i]}, s.settings.iso);
            }
        };
        for (std::size_t brick = begin; brick < end; ++brick) for_each_clustered_member(s.grid.bricks[brick], place_block);
    });
    s.field_evaluations += evaluations.load(std::memory_order_relaxed);
}

}  // namespace meniscus::cpu
