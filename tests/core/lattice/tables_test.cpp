// Every case of both tables, one by one, against the face rule stated a second time.
#include "lattice/tables/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

namespace meniscus {
namespace {

using DirectedEdges = std::map<std::pair<int, int>, int>;  ///< (from, to), smaller first, to signed use

void use(DirectedEdges& edges, int from, int to) {
    edges[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
}

void drop_balanced(DirectedEdges& edges) {
    std::erase_if(edges, [](const auto& e) { return e.second == 0; });
}

template <class Case>
DirectedEdges boundary(const Case& pattern) {
    DirectedEdges edges;
    for (int t = 0; t < pattern.triangles; ++t)
        for (int i = 0; i < 3; ++i) {
            const auto at = [&](int k) { return pattern.edges[static_cast<std::size_t>(3 * t + k % 3)]; };
            use(edges, at(i), at(i + 1));
        }
    drop_balanced(edges);
    return edges;
}

/// Segments of a square face whose corners are walked counter-clockwise seen from outside: around each run of inside
/// corners, from the side where the walk enters to the side where it leaves.
template <class EdgeOf>
void add_face_segments(const std::array<bool, 4>& inside, const EdgeOf& edge_of, int sign, DirectedEdges& edges) {
    const auto in = [&](int i) { return inside[static_cast<std::size_t>(i & 3)]; };
    for (int enter = 0; enter < 4; ++enter) {
        if (in(enter) || !in(enter + 1)) continue;
        int leave = enter + 1;
        while (in(leave + 1)) ++leave;
        if (sign > 0)
            use(edges, edge_of(enter), edge_of(leave & 3));
        else
            use(edges, edge_of(leave & 3), edge_of(enter));
    }
}

struct CubeEdge {
    int a, b;
};

CubeEdge corners_of_cube_edge(int edge) {
    const int axis = edge / 4;
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    const int a = (edge & 1) << first | (edge >> 1 & 1) << second;
    return {a, a | 1 << axis};
}

int cube_edge_between(int a, int b) {
    for (int e = 0; e < 12; ++e) {
        const CubeEdge edge = corners_of_cube_edge(e);
        if ((edge.a == a && edge.b == b) || (edge.a == b && edge.b == a)) return e;
    }
    ADD_FAILURE() << "no edge between corners " << a << " and " << b;
    return -1;
}

const std::vector<std::array<int, 4>>& cube_faces() {
    // Counter-clockwise seen from outside, written out by hand.
    static const std::vector<std::array<int, 4>> faces{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    return faces;
}

TEST(CubeTable, ItsTrianglesBoundExactlyTheFaceSegmentsOfEveryCase) {
    for (int c = 0; c < cube_case_count; ++c) {
        DirectedEdges expected;
        for (const auto& face : cube_faces()) {
            std::array<bool, 4> inside{};
            for (std::size_t i = 0; i < 4; ++i) inside[i] = (c >> face[i] & 1) != 0;
            add_face_segments(
                inside,
                [&](int i) {
                    return cube_edge_between(face[static_cast<std::size_t>(i)],
                                             face[static_cast<std::size_t>((i + 1) & 3)]);
                },
                1, expected);
        }
        drop_balanced(expected);
        EXPECT_EQ(boundary(cube_table[static_cast<std::size_t>(c)]), expected) << "case " << c;
    }
}

TEST(CubeTable, UsesEveryCrossedEdgeAndNoOther) {
    for (int c = 0; c < cube_case_count; ++c) {
        const CubeCase& pattern = cube_table[static_cast<std::size_t>(c)];
        std::set<int> used(pattern.edges.begin(), pattern.edges.begin() + 3 * pattern.triangles);
        std::set<int> crossed;
        for (int e = 0; e < 12; ++e) {
            const CubeEdge edge = corners_of_cube_edge(e);
            if ((c >> edge.a & 1) != (c >> edge.b & 1)) crossed.insert(e);
        }
        EXPECT_EQ(used, crossed) << "case " << c;
    }
}

TEST(CubeTable, HasNoDiagonalInAFaceOfTheCube) {
    for (int c = 0; c < cube_case_count; ++c) {
        const CubeCase& pattern = cube_table[static_cast<std::size_t>(c)];
        const DirectedEdges outline = boundary(pattern);
        for (int t = 0; t < pattern.triangles; ++t)
            for (int i = 0; i < 3; ++i) {
                const int p = pattern.edges[static_cast<std::size_t>(3 * t + i)];
                const int q = pattern.edges[static_cast<std::size_t>(3 * t + (i + 1) % 3)];
                if (outline.contains({std::min(p, q), std::max(p, q)})) continue;
                for (const auto& face : cube_faces()) {
                    const auto on_face = [&](int e) {
                        const CubeEdge edge = corners_of_cube_edge(e);
                        return std::count(face.begin(), face.end(), edge.a) +
                                   std::count(face.begin(), face.end(), edge.b) ==
                               2;
                    };
                    EXPECT_FALSE(on_face(p) && on_face(q)) << "case " << c << ", diagonal " << p << " to " << q;
                }
            }
    }
}

TEST(CubeTable, HasAtMostFiveTrianglesAndLoopsOfAtMostSevenPoints) {
    int most = 0;
    std::size_t longest = 0;
    for (const CubeCase& pattern : cube_table) {
        most = std::max<int>(most, pattern.triangles);
        // The outline's edges form the loops: follow each.
        std::map<int, int> next;
        for (const auto& [edge, sign] : boundary(pattern))
            next[sign > 0 ? edge.first : edge.second] = sign > 0 ? edge.second : edge.first;
        while (!next.empty()) {
            std::size_t length = 0;
            for (auto at = next.begin(); at != next.end(); ++length) {
                const int to = at->second;
                next.erase(at);
                at = next.find(to);
            }
            longest = std::max(longest, length);
        }
    }
    EXPECT_EQ(most, 5);
    EXPECT_EQ(longest, 7U);
}

TEST(CubeTable, LooksOutwardForOneInsideCorner) {
    // Inside corner (0,0,0): points on the x, y and z edges in this order look along (1,1,1).
    const CubeCase& pattern = cube_table[1];
    ASSERT_EQ(pattern.triangles, 1);
    std::array<int, 3> edges{pattern.edges[0], pattern.edges[1], pattern.edges[2]};
    std::rotate(edges.begin(), std::min_element(edges.begin(), edges.end()), edges.end());
    EXPECT_EQ(edges, (std::array<int, 3>{0, 4, 8}));
}

// ---- crack ------------------------------------------------------------------------------------------------------

std::array<int, 2> points_of_fine_edge(int edge) {
    const int p = edge < 6 ? edge % 2 + 3 * (edge / 2) : (edge - 6) % 3 + 3 * ((edge - 6) / 3);
    return {p, p + (edge < 6 ? 1 : 3)};
}

int fine_edge_between(int p, int q) {
    for (int e = 0; e < 12; ++e)
        if (points_of_fine_edge(e) == std::array<int, 2>{std::min(p, q), std::max(p, q)}) return e;
    ADD_FAILURE() << "no fine edge between points " << p << " and " << q;
    return -1;
}

struct CrackOutline {
    DirectedEdges fine, coarse, chords;
};

CrackOutline crack_outline(int c) {
    CrackOutline outline;
    const auto in = [&](int p) { return (c >> p & 1) != 0; };
    // Seen from below the axis, outside of the fine cells above: v before u.
    const auto face = [](int corner, int step) {
        return std::array<int, 4>{corner, corner + 3 * step, corner + 4 * step, corner + step};
    };
    for (const int corner : {0, 1, 3, 4}) {
        const auto p = face(corner, 1);
        add_face_segments(
            {in(p[0]), in(p[1]), in(p[2]), in(p[3])},
            [&](int i) {
                return fine_edge_between(p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>((i + 1) & 3)]);
            },
            1, outline.fine);
    }
    const auto p = face(0, 2);
    const auto coarse_point = [&](int i) {
        const int a = p[static_cast<std::size_t>(i)];
        const int b = p[static_cast<std::size_t>((i + 1) & 3)];
        const int middle = (a + b) / 2;
        return in(a) != in(middle) ? fine_edge_between(a, middle) : fine_edge_between(middle, b);
    };
    // The coarse cell's own triangles use these segments the other way round: it lies on the other side.
    add_face_segments({in(p[0]), in(p[1]), in(p[2]), in(p[3])}, coarse_point, -1, outline.coarse);
    for (int i = 0; i < 4; ++i) {
        const int a = p[static_cast<std::size_t>(i)];
        const int b = p[static_cast<std::size_t>((i + 1) & 3)];
        const int middle = (a + b) / 2;
        if (in(a) == in(b) && in(a) != in(middle))
            outline.chords[std::minmax(fine_edge_between(a, middle), fine_edge_between(middle, b))] = 1;
    }
    return outline;
}

TEST(CrackTable, ClosesTheGapBetweenFineAndCoarseTrianglesUpToChordsOfCoarseEdges) {
    for (int c = 0; c < crack_case_count; ++c) {
        const CrackOutline outline = crack_outline(c);
        DirectedEdges sum = boundary(crack_table[static_cast<std::size_t>(c)]);
        for (const auto* part : {&outline.fine, &outline.coarse})
            for (const auto& [edge, sign] : *part) sum[edge] += sign;
        drop_balanced(sum);
        std::set<std::pair<int, int>> left;
        for (const auto& [edge, sign] : sum) {
            EXPECT_EQ(std::abs(sign), 1) << "case " << c;
            left.insert(edge);
        }
        std::set<std::pair<int, int>> chords;
        for (const auto& chord : outline.chords) chords.insert(chord.first);
        EXPECT_EQ(left, chords) << "case " << c;
    }
}

TEST(CrackTable, HasNoDiagonalAlongACoarseEdgeAndNoEdgeOfThreeTriangles) {
    const std::array<std::array<int, 2>, 4> coarse_edges{{{0, 1}, {4, 5}, {6, 9}, {8, 11}}};
    for (int c = 0; c < crack_case_count; ++c) {
        const CrackCase& pattern = crack_table[static_cast<std::size_t>(c)];
        std::map<std::pair<int, int>, int> uses;
        for (int t = 0; t < pattern.triangles; ++t)
            for (int i = 0; i < 3; ++i) {
                const int p = pattern.edges[static_cast<std::size_t>(3 * t + i)];
                const int q = pattern.edges[static_cast<std::size_t>(3 * t + (i + 1) % 3)];
                ++uses[std::minmax(p, q)];
            }
        for (const auto& [edge, count] : uses) {
            EXPECT_LE(count, 2) << "case " << c;
            for (const auto& coarse : coarse_edges)
                if (edge == std::pair<int, int>{coarse[0], coarse[1]}) {
                    EXPECT_EQ(count, 1) << "case " << c;
                }
        }
    }
}

TEST(CrackTable, HasTheKnownNumbersOfTriangles) {
    std::array<int, 9> histogram{};
    for (const CrackCase& pattern : crack_table) ++histogram.at(pattern.triangles);
    EXPECT_EQ(histogram, (std::array<int, 9>{12, 56, 110, 132, 115, 56, 18, 12, 1}));
}

}  // namespace
}  // namespace meniscus
