// Which of a surface's figures belong to a box of bricks.
#include "meniscus/brick_box.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>

#include "meniscus/error.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus {
namespace {

std::string text_of(const BrickCoordinate& place) {
    return "(" + std::to_string(place[0]) + ", " + std::to_string(place[1]) + ", " + std::to_string(place[2]) + ")";
}

/// Calls visit(triangle) for each of the brick's.
template <class Visit>
void for_each_triangle(const Mesh& mesh, const MeshBrick& brick, const Visit& visit) {
    for (const TriangleRange& range : brick.ranges)
        for (std::uint32_t t = 0; t < range.count; ++t) visit(mesh.triangles[range.first + t]);
}

/// Which vertices the bricks have.
std::vector<bool> vertices_of(const Mesh& mesh, const std::vector<std::uint32_t>& bricks) {
    std::vector<bool> has(mesh.vertices.size());
    for (const std::uint32_t brick : bricks)
        for_each_triangle(mesh, mesh.bricks[brick], [&](const Triangle& triangle) {
            for (const std::uint32_t vertex : triangle) has[vertex] = true;
        });
    return has;
}

std::vector<AttributeRange> ranges_of(const Mesh& mesh, const std::vector<bool>& vertices) {
    Mesh own;
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (vertices[v]) own.vertices.push_back(mesh.vertices[v]);
    for (const MeshAttribute& attribute : mesh.attributes) {
        MeshAttribute& mine = own.attributes.emplace_back(
            MeshAttribute{attribute.name, attribute.type, attribute.components, Array<std::byte>()});
        const std::size_t bytes = attribute.element_bytes();
        mine.data.reserve(own.vertices.size() * bytes);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (vertices[v])
                mine.data.insert(mine.data.end(), attribute.data.begin() + static_cast<std::ptrdiff_t>(v * bytes),
                                 attribute.data.begin() + static_cast<std::ptrdiff_t>((v + 1) * bytes));
    }
    return attribute_ranges(own);
}

/// The signed area of a triangle seen along z, doubled, u^2.
std::int64_t doubled_area(const Mesh& mesh, const Triangle& triangle) {
    const LatticePosition& a = mesh.vertices[triangle[0]];
    const LatticePosition& b = mesh.vertices[triangle[1]];
    const LatticePosition& c = mesh.vertices[triangle[2]];
    return std::int64_t{b[0] - a[0]} * (c[1] - a[1]) - std::int64_t{c[0] - a[0]} * (b[1] - a[1]);
}

/// Six times the volume of the fluid within the box, u^3, modulo 2^64. By the divergence theorem for the field
/// (0, 0, z - z0), z0 the box's lower face, it is the sum over the box's triangles, as that of a whole mesh, and the
/// area of the fluid on its upper face times its height. The fluid is above a point where one more triangle is seen
/// from above than from below, of those above the point: this area is the sum of theirs, each with its sign.
std::uint64_t sixfold_volume_within(const Mesh& mesh, const BrickBox& box) {
    if (mesh.bricks.empty()) return 0;
    // Beyond the mesh there is nothing: a box without an end there has that of the mesh.
    const std::int64_t lowest = std::max(box.low[2], mesh.bricks.front().coordinate[2]);
    const std::int64_t highest = std::min(box.high[2] - 1, mesh.bricks.back().coordinate[2]);
    if (lowest > highest) return 0;
    const std::int64_t edge = std::int64_t{brick_cells} << mesh.offset_bits;
    const auto bottom = static_cast<std::uint64_t>(lowest * edge);
    const auto height = static_cast<std::uint64_t>((highest + 1 - lowest) * edge);
    std::uint64_t volume = 0;
    std::uint64_t area_within = 0;
    std::uint64_t area_above = 0;
    for (const MeshBrick& brick : mesh.bricks) {
        const bool is_above = brick.coordinate[2] > highest;
        if (!box.holds({brick.coordinate[0], brick.coordinate[1], is_above ? box.low[2] : brick.coordinate[2]}))
            continue;
        for_each_triangle(mesh, brick, [&](const Triangle& triangle) {
            const auto area = static_cast<std::uint64_t>(doubled_area(mesh, triangle));
            if (is_above) {
                area_above += area;
            } else {
                area_within += area;
                volume += static_cast<std::uint64_t>(sixfold_volume(mesh.vertices.data(), triangle));
            }
        });
    }
    constexpr std::uint64_t sixfold_of_doubled = 3;
    return volume + sixfold_of_doubled * (height * area_above - bottom * area_within);
}

/// The vertices that no brick before those of the box has. (Where they lie does not say whose they are: beside a
/// coarser cell the brick above a border has not all vertices on it.)
std::uint64_t vertices_first_in(const Mesh& mesh, const BrickBox& box) {
    std::vector<bool> seen(mesh.vertices.size());
    std::uint64_t count = 0;
    for (const MeshBrick& brick : mesh.bricks) {
        const bool is_within = box.holds(brick.coordinate);
        for_each_triangle(mesh, brick, [&](const Triangle& triangle) {
            for (const std::uint32_t vertex : triangle) {
                if (is_within && !seen[vertex]) ++count;
                seen[vertex] = true;
            }
        });
    }
    return count;
}

void count(const Mesh& mesh, const BrickBox& box, SurfacePart& part) {
    Statistics& statistics = part.statistics;
    statistics.vertices = vertices_first_in(mesh, box);
    statistics.triangles = 0;
    statistics.triangles_by_level = {};
    for (const std::uint32_t brick : part.bricks) {
        statistics.triangles += mesh.bricks[brick].triangle_count();
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            statistics.triangles_by_level[level] += mesh.bricks[brick].ranges[level].count;
    }
}

/// Those whose places lie in the box.
std::vector<Point> spray_within(const Mesh& mesh, const BrickBox& box) {
    const double edge = brick_cells * mesh.cell_size;
    const auto is_within = [&](const Point& point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double brick = std::floor(double{point[axis]} / edge);
            if (brick < box.low[axis] || brick >= box.high[axis]) return false;
        }
        return true;
    };
    std::vector<Point> within;
    std::copy_if(mesh.spray.begin(), mesh.spray.end(), std::back_inserter(within), is_within);
    return within;
}

}  // namespace

double halo(const Settings& settings) {
    // The neighbor's surface, that of its neighbor for the balance of levels, and two more for cells that are promoted.
    constexpr double cells_of_neighbors = 4.0;
    const double around = settings.mode == Mode::adaptive ? cells_of_neighbors : 0.0;
    return margin(settings) + around * base_cell_size * settings.cell_size;
}

BrickBox bricks_between(const BrickCoordinate& lowest, const BrickCoordinate& highest) {
    BrickBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (lowest[axis] > highest[axis])
            throw InvalidInput("the box of bricks runs from " + text_of(lowest) + " to " + text_of(highest) +
                               "; the lowest must not be beyond the highest");
        // Beyond there are none.
        box.low[axis] = std::clamp(lowest[axis], -brick_end, brick_end);
        box.high[axis] = std::clamp(highest[axis], -brick_end - 1, brick_end - 1) + 1;
    }
    return box;
}

SurfacePart part_of(const Mesh& mesh, const Statistics& statistics, const BrickBox& box) {
    SurfacePart part;
    part.statistics = statistics;
    for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
        if (box.holds(mesh.bricks[b].coordinate)) part.bricks.push_back(static_cast<std::uint32_t>(b));
    part.ranges = ranges_of(mesh, vertices_of(mesh, part.bricks));
    part.spray = spray_within(mesh, box);
    count(mesh, box, part);
    if (!mesh.spray.empty()) part.statistics.spray_particles = part.spray.size();
    part.statistics.volume = world_volume(sixfold_volume_within(mesh, box), mesh.cell_size, mesh.offset_bits);
    return part;
}

}  // namespace meniscus
