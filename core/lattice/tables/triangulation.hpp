// Cuts a closed polygon into triangles whose new sides (the diagonals) all satisfy a condition.
#pragma once

#include <array>
#include <cstdint>

namespace meniscus {

/// A closed polygon of edge points, each named by the edge that it lies on.
struct Loop {
    int size = 0;
    std::array<std::uint8_t, 12> points{};
};

/// Triangles of loop[first..last] and its chord (last, first), appended in loop order. allowed(a, b) says whether the
/// points a and b may be joined by a diagonal. Returns false, with nothing appended, if there is no such triangulation.
template <class Output, class Allowed>
constexpr bool triangulate(const Loop& loop, int first, int last, Output& output, const Allowed& allowed) {
    if (last - first < 2) return true;
    const auto point = [&](int i) { return loop.points[static_cast<std::size_t>(i)]; };
    const auto joined = [&](int a, int b) {
        const bool side = b - a == 1 || (a == 0 && b == loop.size - 1);
        return side || allowed(point(a), point(b));
    };
    for (int apex = first + 1; apex < last; ++apex) {
        if (!joined(first, apex) || !joined(apex, last)) continue;
        const auto before = output.triangles;
        if (triangulate(loop, first, apex, output, allowed) && triangulate(loop, apex, last, output, allowed)) {
            const auto at = static_cast<std::size_t>(3 * output.triangles++);
            output.edges[at] = point(first);
            output.edges[at + 1] = point(apex);
            output.edges[at + 2] = point(last);
            return true;
        }
        output.triangles = before;
    }
    return false;
}

}  // namespace meniscus
