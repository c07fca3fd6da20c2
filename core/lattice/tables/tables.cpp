// Both tables come from join_face(), so that they cannot disagree about a face.
#include "lattice/tables/tables.hpp"

#include "lattice/tables/face_rule.hpp"
#include "lattice/tables/triangulation.hpp"

namespace meniscus {
namespace {

constexpr int none = -1;

constexpr std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

/// The next point of its loop for every edge point, or none; then all loops in triangles.
template <class Case, class Allowed>
constexpr Case triangulate_loops(const std::array<int, 12>& next, const Allowed& allowed) {
    Case result;
    std::array<bool, 12> used{};
    for (int start = 0; start < 12; ++start) {
        if (next[at(start)] == none || used[at(start)]) continue;
        Loop loop;
        for (int edge = start; !used[at(edge)]; edge = next[at(edge)]) {
            used[at(edge)] = true;
            loop.points[at(loop.size++)] = static_cast<std::uint8_t>(edge);
        }
        if (!triangulate(loop, 0, loop.size - 1, result, allowed)) throw "a case has no triangulation";
    }
    return result;
}

// ---- cube -------------------------------------------------------------------------------------------------------

constexpr int corner_coordinate(int corner, int axis) {
    return corner >> axis & 1;
}

/// The edge between two corners that differ in one coordinate.
constexpr int cube_edge(int a, int b) {
    int axis = 0;
    while (corner_coordinate(a, axis) == corner_coordinate(b, axis)) ++axis;
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    return 4 * axis + corner_coordinate(a, first) + 2 * corner_coordinate(a, second);
}

/// Corners of a face, counter-clockwise seen from outside the cube.
constexpr std::array<int, 4> cube_face(int axis, int side) {
    const int u = 1 << ((axis + 1) % 3);
    const int v = 1 << ((axis + 2) % 3);
    const int base = side << axis;
    return side == 1 ? std::array<int, 4>{base, base + u, base + u + v, base + v}
                     : std::array<int, 4>{base, base + v, base + u + v, base + u};
}

/// Bit set of the faces (axis + 3 side) that touch an edge.
constexpr unsigned faces_of_cube_edge(int edge) {
    const int axis = edge / 4;
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    return 1U << (first + 3 * (edge & 1)) | 1U << (second + 3 * (edge >> 1 & 1));
}

/// A diagonal in a face of the cube could meet the same one of the neighboring cube.
constexpr bool off_the_faces(int a, int b) {
    return (faces_of_cube_edge(a) & faces_of_cube_edge(b)) == 0;
}

constexpr CubeCase make_cube_case(int inside) {
    std::array<int, 12> next{};
    for (int& n : next) n = none;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const std::array<int, 4> corners = cube_face(axis, side);
            std::array<bool, 4> is_inside{};
            for (int i = 0; i < 4; ++i) is_inside[at(i)] = (inside >> corners[at(i)] & 1) != 0;
            const FaceSegments joined = join_face(is_inside);
            for (int s = 0; s < joined.count; ++s) {
                const auto edge = [&](int i) { return cube_edge(corners[at(i)], corners[at((i + 1) % 4)]); };
                next[at(edge(joined.segments[at(s)].enter))] = edge(joined.segments[at(s)].leave);
            }
        }
    return triangulate_loops<CubeCase>(next, off_the_faces);
}

// ---- crack ------------------------------------------------------------------------------------------------------

constexpr int fine_edge_u(int u, int v) {
    return u + 2 * v;
}
constexpr int fine_edge_v(int u, int v) {
    return 6 + u + 3 * v;
}

/// The fine edge between two neighboring points of the 3 x 3 grid.
constexpr int fine_edge(int a, int b) {
    const int low = a < b ? a : b;
    const int high = a < b ? b : a;
    return high - low == 1 ? fine_edge_u(low % 3, low / 3) : fine_edge_v(low % 3, low / 3);
}

/// The coarse edge (side of the face) that holds a fine edge: 0 v = 0, 1 v = 2, 2 u = 0, 3 u = 2; none inside the face.
constexpr int coarse_edge_of(int edge) {
    if (edge < 6) return edge / 2 == 0 ? 0 : edge / 2 == 2 ? 1 : none;
    return (edge - 6) % 3 == 0 ? 2 : (edge - 6) % 3 == 2 ? 3 : none;
}

/// A diagonal along a coarse edge could meet a chord or a diagonal of the neighboring face.
constexpr bool off_the_coarse_edges(int a, int b) {
    return coarse_edge_of(a) == none || coarse_edge_of(a) != coarse_edge_of(b);
}

constexpr CrackCase make_crack_case(int inside) {
    const auto is_inside = [&](int point) { return (inside >> point & 1) != 0; };
    const auto crossed = [&](int a, int b) { return is_inside(a) != is_inside(b); };
    std::array<int, 12> next{};
    for (int& n : next) n = none;

    // The walk around a face that is counter-clockwise seen from outside the fine cells, which lie in the direction of
    // the axis.
    const auto walk = [](int base, int step) {
        return std::array<int, 4>{base, base + 3 * step, base + 4 * step, base + step};
    };
    const auto join = [&](const std::array<int, 4>& corners, auto&& connect) {
        std::array<bool, 4> signs{};
        for (int i = 0; i < 4; ++i) signs[at(i)] = is_inside(corners[at(i)]);
        const FaceSegments joined = join_face(signs);
        for (int s = 0; s < joined.count; ++s) connect(joined.segments[at(s)]);
    };
    // Where a fine cell's triangles run along a segment one way, the filling runs the other way.
    for (int subface = 0; subface < 4; ++subface) {
        const std::array<int, 4> corners = walk(subface % 2 + 3 * (subface / 2), 1);
        const auto edge = [&](int i) { return fine_edge(corners[at(i)], corners[at((i + 1) % 4)]); };
        join(corners, [&](const FaceSegment& s) { next[at(edge(s.leave))] = edge(s.enter); });
    }
    // The coarse cell sees the same face from the other side. Its point on an edge is that of the half that crosses.
    {
        const std::array<int, 4> corners = walk(0, 2);
        const auto edge = [&](int i) {
            const int a = corners[at(i)];
            const int b = corners[at((i + 1) % 4)];
            const int middle = (a + b) / 2;
            return crossed(a, middle) ? fine_edge(a, middle) : fine_edge(middle, b);
        };
        join(corners, [&](const FaceSegment& s) { next[at(edge(s.enter))] = edge(s.leave); });
        // A coarse edge that both its halves cross: a chord from the point without a successor to the one without a
        // predecessor.
        for (int i = 0; i < 4; ++i) {
            const int a = corners[at(i)];
            const int b = corners[at((i + 1) % 4)];
            const int middle = (a + b) / 2;
            if (!crossed(a, middle) || !crossed(middle, b)) continue;
            const int p = fine_edge(a, middle);
            const int q = fine_edge(middle, b);
            const bool from_p = next[at(p)] == none;
            next[at(from_p ? p : q)] = from_p ? q : p;
        }
    }
    return triangulate_loops<CrackCase>(next, off_the_coarse_edges);
}

constexpr CubeTable make_cube_table() {
    CubeTable table{};
    for (int i = 0; i < cube_case_count; ++i) table[at(i)] = make_cube_case(i);
    return table;
}

constexpr CrackTable make_crack_table() {
    CrackTable table{};
    for (int i = 0; i < crack_case_count; ++i) table[at(i)] = make_crack_case(i);
    return table;
}

}  // namespace

constexpr CubeTable cube_table = make_cube_table();
constexpr CrackTable crack_table = make_crack_table();

}  // namespace meniscus
