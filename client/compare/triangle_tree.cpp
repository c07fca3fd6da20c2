#include "compare/triangle_tree.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "compare/triangle_distance.hpp"

namespace meniscus::compare {
namespace {

/// Children of a node, and triangles of a lowest box.
constexpr std::size_t branching = 4;
/// Levels of a tree of 2^32 triangles: log4 of that.
constexpr std::size_t most_levels = 16;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t morton_bits = 21;

/// Bit i of the 21 goes to bit 3 i.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffffULL;
    x = (x | x << 16) & 0x001f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

Point center(const std::array<Point, 3>& t) {
    Point c{};
    for (std::size_t k = 0; k < 3; ++k) c[k] = (t[0][k] + t[1][k] + t[2][k]) / 3.0;
    return c;
}

/// The triangles' indices along the Morton curve of their centers.
std::vector<std::uint32_t> morton_order(SurfaceView surface) {
    Point low{infinity, infinity, infinity};
    double size = 0.0;
    for (const Triangle& t : surface.triangles) {
        const Point c = center(surface.corners(t));
        for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], c[k]);
    }
    for (const Triangle& t : surface.triangles) {
        const Point c = center(surface.corners(t));
        for (std::size_t k = 0; k < 3; ++k) size = std::max(size, c[k] - low[k]);
    }
    const double scale = size > 0.0 ? static_cast<double>((1U << morton_bits) - 1U) / size : 0.0;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
        const Point c = center(surface.corners(t));
        std::uint64_t key = 0;
        for (std::size_t k = 0; k < 3; ++k) key |= spread(static_cast<std::uint64_t>((c[k] - low[k]) * scale)) << k;
        keys.emplace_back(key, static_cast<std::uint32_t>(keys.size()));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const auto& key : keys) order.push_back(key.second);
    return order;
}

}  // namespace

TriangleTree::TriangleTree(SurfaceView surface) {
    triangles_.reserve(surface.triangles.size());
    for (const std::uint32_t i : morton_order(surface)) triangles_.push_back(surface.corners(surface.triangles[i]));

    constexpr Box nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    const auto parents = [](std::size_t children) { return (children + branching - 1) / branching; };
    std::vector<Box> boxes(parents(triangles_.size()), nothing);
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        for (const Point& p : triangles_[i])
            for (std::size_t k = 0; k < 3; ++k) {
                Box& box = boxes[i / branching];
                box.low[k] = std::min(box.low[k], p[k]);
                box.high[k] = std::max(box.high[k], p[k]);
            }
    levels_.push_back(std::move(boxes));
    while (levels_.back().size() > 1) {
        const std::vector<Box>& children = levels_.back();
        std::vector<Box> above(parents(children.size()), nothing);
        for (std::size_t i = 0; i < children.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                Box& box = above[i / branching];
                box.low[k] = std::min(box.low[k], children[i].low[k]);
                box.high[k] = std::max(box.high[k], children[i].high[k]);
            }
        levels_.push_back(std::move(above));
    }
}

double TriangleTree::squared_distance(const Point& point, const Box& box) {
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double outside = std::max({box.low[k] - point[k], point[k] - box.high[k], 0.0});
        square += outside * outside;
    }
    return square;
}

double TriangleTree::squared_distance(const Point& point, std::uint32_t& hint) const {
    struct Node {
        double square;  ///< of the distance to its box
        std::uint32_t level;
        std::uint32_t index;
    };
    std::array<Node, most_levels * branching> stack;
    std::size_t waiting = 0;
    if (hint >= triangles_.size()) hint = 0;
    double best = compare::squared_distance(point, triangles_[hint]);
    stack[waiting++] = {squared_distance(point, levels_.back()[0]), static_cast<std::uint32_t>(levels_.size() - 1), 0};
    while (waiting > 0) {
        const Node node = stack[--waiting];
        if (!(node.square < best)) continue;
        const std::size_t first = std::size_t{node.index} * branching;
        if (node.level == 0) {
            const std::size_t last = std::min(first + branching, triangles_.size());
            for (std::size_t i = first; i < last; ++i) {
                const double square = compare::squared_distance(point, triangles_[i]);
                if (!(square < best)) continue;
                best = square;
                hint = static_cast<std::uint32_t>(i);
            }
            continue;
        }
        const std::vector<Box>& children = levels_[node.level - 1];
        const std::size_t last = std::min(first + branching, children.size());
        const std::size_t begin = waiting;
        for (std::size_t i = first; i < last; ++i) {
            const Node child{squared_distance(point, children[i]), node.level - 1, static_cast<std::uint32_t>(i)};
            if (!(child.square < best)) continue;
            // The nearest child ends up on top.
            std::size_t at = waiting++;
            for (; at > begin && stack[at - 1].square < child.square; --at) stack[at] = stack[at - 1];
            stack[at] = child;
        }
    }
    return best;
}

}  // namespace meniscus::compare
