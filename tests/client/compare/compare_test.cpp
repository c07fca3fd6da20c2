// The comparison of meshes: known answers, and an oracle that tries all pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "compare/closedness.hpp"
#include "compare/comparison.hpp"
#include "compare/triangle_distance.hpp"
#include "compare/triangle_tree.hpp"
#include "compare_shapes.hpp"
#include "meniscus/error.hpp"
#include "support/mesh_check.hpp"

namespace meniscus::compare {
namespace {

/// Triangles anywhere: large, small, thin, without area.
Shape random_triangles(std::mt19937& random, std::size_t count) {
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    std::uniform_int_distribution<int> kind(0, 3);
    const auto point = [&](double size) {
        return Point{size * coordinate(random), size * coordinate(random), size * coordinate(random)};
    };
    Shape out;
    for (std::size_t i = 0; i < count; ++i) {
        const Point a = point(1.0);
        Point b = point(1.0);
        Point c = point(1.0);
        const int k = kind(random);
        for (std::size_t x = 0; x < 3; ++x) {
            if (k == 0) b[x] = a[x] + 0.05 * b[x];
            if (k == 0) c[x] = a[x] + 0.05 * c[x];
            if (k == 1) c[x] = 0.3 * a[x] + 0.7 * b[x] + 1e-7 * c[x];
            if (k == 2 && i % 2 == 0) c[x] = b[x];
        }
        const auto first = static_cast<std::uint32_t>(out.positions.size());
        out.positions.insert(out.positions.end(), {a, b, c});
        out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
}

/// An upper bound by search: the square of the distance from the point to the triangle is convex in each of both
/// parameters, and so is its minimum over the inner one.
double searched_distance(const Point& p, const std::array<Point, 3>& t) {
    const auto square_at = [&](double u, double v) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]) - p[k];
            sum += x * x;
        }
        return sum;
    };
    const auto minimize = [](double high, const auto& f) {
        double low = 0.0;
        for (int i = 0; i < 80; ++i) {
            const double third = (high - low) / 3.0;
            if (f(low + third) < f(high - third))
                high -= third;
            else
                low += third;
        }
        return f(0.5 * (low + high));
    };
    return std::sqrt(
        minimize(1.0, [&](double u) { return minimize(1.0 - u, [&](double v) { return square_at(u, v); }); }));
}

double distance_to(const Shape& shape, const Point& p) {
    std::uint32_t hint = 0;
    return std::sqrt(TriangleTree(shape.view()).squared_distance(p, hint));
}

TEST(TriangleDistance, FaceEdgeAndCornerAreMeasured) {
    const std::array<Point, 3> t{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
    EXPECT_DOUBLE_EQ(squared_distance({0.5, 0.5, 3.0}, t), 9.0);
    EXPECT_DOUBLE_EQ(squared_distance({0.5, 0.5, -3.0}, t), 9.0);
    EXPECT_DOUBLE_EQ(squared_distance({1.0, -2.0, 0.0}, t), 4.0);
    EXPECT_DOUBLE_EQ(squared_distance({2.0, 2.0, 1.0}, t), 3.0);
    EXPECT_DOUBLE_EQ(squared_distance({5.0, -4.0, 0.0}, t), 25.0);
    EXPECT_DOUBLE_EQ(squared_distance({0.25, 0.5, 0.0}, t), 0.0);
}

TEST(TriangleDistance, TrianglesWithoutAreaAreSegmentsAndPoints) {
    EXPECT_DOUBLE_EQ(squared_distance({1.0, 3.0, 0.0}, {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}), 9.0);
    EXPECT_DOUBLE_EQ(squared_distance({4.0, 0.0, 0.0}, {{{0, 0, 0}, {2, 0, 0}, {0, 0, 0}}}), 4.0);
    EXPECT_DOUBLE_EQ(squared_distance({1.0, 1.0, 1.0}, {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}), 3.0);
}

TEST(TriangleDistance, AgreesWithASearchOfTheTriangle) {
    std::mt19937 random(1);
    const Shape triangles = random_triangles(random, 200);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    for (const Triangle& t : triangles.triangles) {
        const Point p{coordinate(random), coordinate(random), coordinate(random)};
        const std::array<Point, 3> corners = triangles.view().corners(t);
        EXPECT_NEAR(std::sqrt(squared_distance(p, corners)), searched_distance(p, corners), 1e-6);
    }
}

TEST(TriangleTree, FindsTheNearestOfAllTrianglesForAnyHint) {
    std::mt19937 random(2);
    for (const std::size_t count : {1U, 2U, 4U, 5U, 16U, 17U, 64U, 65U, 700U}) {
        const Shape shape = random_triangles(random, count);
        const TriangleTree tree(shape.view());
        std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
        std::uint32_t hint = 0;
        for (int i = 0; i < 200; ++i) {
            const Point p{coordinate(random), coordinate(random), coordinate(random)};
            double nearest = std::numeric_limits<double>::infinity();
            for (const Triangle& t : shape.triangles)
                nearest = std::min(nearest, squared_distance(p, shape.view().corners(t)));
            EXPECT_EQ(tree.squared_distance(p, hint), nearest) << count << " triangles";
            auto other_hint = static_cast<std::uint32_t>(random());
            EXPECT_EQ(tree.squared_distance(p, other_hint), nearest) << count << " triangles";
        }
    }
}

TEST(TriangleTree, MeasuresToTheSurfaceNotToItsVertices) {
    EXPECT_DOUBLE_EQ(distance_to(square().moved({0, 0, 0}, 1000.0), {500.0, 400.0, 0.25}), 0.25);
}

TEST(Samples, LieOnTheSurfaceInProportionToArea) {
    const Shape shape = square().add(square(), {5.0, 0.0, 0.0}, 3.0);
    const Samples samples = sample(shape.view(), find_components(shape.view()), 10'000);
    ASSERT_EQ(samples.starts.size(), 3U);
    EXPECT_NEAR(static_cast<double>(samples.starts[1]), 1000.0, 1.0);
    EXPECT_NEAR(static_cast<double>(samples.starts[2]), 10'000.0, 2.0);
    EXPECT_NEAR(samples.area(), 10.0, 1e-9);
    Point mean{};
    for (std::size_t i = 0; i < samples.starts[1]; ++i) {
        EXPECT_NEAR(distance_to(square(), samples.points[i]), 0.0, 1e-14);
        for (std::size_t k = 0; k < 3; ++k) mean[k] += samples.points[i][k] / static_cast<double>(samples.starts[1]);
    }
    EXPECT_NEAR(mean[0], 0.5, 0.02);
    EXPECT_NEAR(mean[1], 0.5, 0.02);
}

TEST(Samples, TheSmallestComponentHasSomeAndWeighsWhatItIs) {
    const Shape shape = cube().moved({0, 0, 0}, 1000.0).add(cube(), {-5.0, 0.0, 0.0}, 0.001);
    const Samples samples = sample(shape.view(), find_components(shape.view()), 100);
    ASSERT_EQ(samples.starts.size(), 3U);
    EXPECT_EQ(samples.starts[2] - samples.starts[1], fewest_samples_per_component);
    EXPECT_NEAR(samples.weights.back() * static_cast<double>(fewest_samples_per_component), 6e-6, 1e-12);
}

TEST(Components, AreTheTrianglesThatShareVertices) {
    const Shape shape = cube().add(cube(), {3.0, 0.0, 0.0}).add(square(), {9.0, 0.0, 0.0});
    const Components components = find_components(shape.view());
    EXPECT_EQ(components.count(), 3U);
    EXPECT_EQ(components.starts, (std::vector<std::uint32_t>{0, 12, 24, 26}));
    EXPECT_TRUE(std::is_sorted(components.triangles.begin(), components.triangles.end()));
}

TEST(Components, AreFoundInAnyOrderOfTheTriangles) {
    Shape shape = cube().add(cube(), {3.0, 0.0, 0.0}).add(cube(), {6.0, 0.0, 0.0});
    std::mt19937 random(3);
    std::shuffle(shape.triangles.begin(), shape.triangles.end(), random);
    const Components components = find_components(shape.view());
    ASSERT_EQ(components.starts, (std::vector<std::uint32_t>{0, 12, 24, 36}));
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = components.starts[k]; i < components.starts[k + 1]; ++i)
            EXPECT_EQ(shape.triangles[components.triangles[i]][0] / 8,
                      shape.triangles[components.triangles[components.starts[k]]][0] / 8);
}

TEST(Closedness, ACubeIsClosed) {
    EXPECT_TRUE(find_defects(cube().view()).closed());
    EXPECT_EQ(find_defects(cube().view()).text(), "");
}

TEST(Closedness, ABorderIsCountedByItsEdges) {
    Shape open = cube();
    open.triangles.pop_back();
    const Defects defects = find_defects(open.view());
    EXPECT_EQ(defects.unbalanced_edges, 3U);
    EXPECT_EQ(defects.count(), 3U);
    EXPECT_FALSE(defects.closed());
    EXPECT_EQ(defects.text(), "3 unbalanced edges");
    EXPECT_EQ(find_defects(square().view()).unbalanced_edges, 4U);
}

TEST(Closedness, ATurnedTriangleIsUnbalanced) {
    Shape turned = cube();
    std::swap(turned.triangles[5][0], turned.triangles[5][1]);
    EXPECT_EQ(find_defects(turned.view()).unbalanced_edges, 3U);
    EXPECT_EQ(find_defects(turned.view()).count(), 3U);
}

TEST(Closedness, TwoCubesAtACommonVertexAreTorn) {
    Shape cubes = cube().add(cube(), {1.0, 1.0, 1.0});
    for (Triangle& t : cubes.triangles)
        for (std::uint32_t& v : t) v = v == 8 ? 7 : v;  // both are at (1, 1, 1)
    const Defects defects = find_defects(cubes.view());
    EXPECT_EQ(defects.torn_vertices, 1U);
    EXPECT_EQ(defects.unused_vertices, 1U);
    EXPECT_EQ(defects.repeated_vertices, 1U);
    EXPECT_EQ(defects.count(), 3U);
}

TEST(Closedness, TwoCubesAtACommonEdgeCrowdIt) {
    Shape cubes = cube().add(cube(), {1.0, 1.0, 0.0});
    for (Triangle& t : cubes.triangles)
        for (std::uint32_t& v : t) v = v == 8 ? 3 : v == 12 ? 7 : v;
    const Defects defects = find_defects(cubes.view());
    EXPECT_EQ(defects.crowded_edges, 1U);
    EXPECT_EQ(defects.unbalanced_edges, 0U);
    EXPECT_EQ(defects.torn_vertices, 0U);
}

TEST(Closedness, ATriangleThatNamesAVertexTwiceIsDegenerate) {
    Shape shape = cube();
    shape.triangles.push_back({1, 1, 2});
    EXPECT_EQ(find_defects(shape.view()).degenerate_triangles, 1U);
    EXPECT_EQ(find_defects(shape.view()).count(), 1U);
}

TEST(Closedness, AgreesWithAnIndependentCheckOnRandomTriangles) {
    std::mt19937 random(6);
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };
    const auto coordinate = [&] { return static_cast<std::int32_t>(below(4)); };
    for (int round = 0; round < 300; ++round) {
        const std::uint32_t vertices = 4 + below(8);
        Mesh mesh;
        mesh.cell_size = 1.0;
        Shape shape;
        for (std::uint32_t v = 0; v < vertices; ++v) {
            mesh.vertices.push_back({coordinate(), coordinate(), coordinate()});
            shape.positions.push_back(mesh.world(mesh.vertices.back()));
        }
        for (std::uint32_t i = 2 + below(20); i > 0; --i) {
            const Triangle t{below(vertices), below(vertices), below(vertices)};
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            mesh.triangles.push_back(t);
            shape.triangles.push_back(t);
        }
        const test::MeshReport expected = test::check(mesh);
        const Defects defects = find_defects(shape.view());
        EXPECT_EQ(defects.repeated_vertices, expected.repeated_vertices);
        EXPECT_EQ(defects.unused_vertices, expected.unused_vertices);
        EXPECT_EQ(defects.unbalanced_edges, expected.unbalanced_edges);
        EXPECT_EQ(defects.crowded_edges, expected.nonmanifold_edges);
        EXPECT_EQ(defects.torn_vertices, expected.nonmanifold_vertices);
        EXPECT_EQ(find_components(shape.view()).count(), expected.components);
    }
}

TEST(Comparison, IdenticalMeshesAreAtDistanceZero) {
    const Shape shape = cube().moved({0.1, 0.2, 0.3}, 1.7);
    const Comparison comparison = compare_surfaces(shape.view(), shape.view(), 5000);
    EXPECT_LT(comparison.distance().max, 1e-15);
    EXPECT_EQ(comparison.triangle_ratio(), 1.0);
    EXPECT_TRUE(comparison.b.missing(1e-6).empty());
    EXPECT_TRUE(comparison.a.missing(1e-6).empty());
}

TEST(Comparison, ParallelSquaresAreAsFarApartAsTheyAreShifted) {
    const Comparison comparison = compare_surfaces(square().view(), square().moved({0.0, 0.0, 0.25}).view(), 1000);
    for (const DistanceSummary& d : {comparison.distance(), comparison.a.distance, comparison.b.distance}) {
        EXPECT_DOUBLE_EQ(d.rms, 0.25);
        EXPECT_DOUBLE_EQ(d.percentile_99, 0.25);
        EXPECT_DOUBLE_EQ(d.max, 0.25);
    }
}

TEST(Comparison, ShiftedCubesDifferByTheShiftAtTwoFaces) {
    const Comparison comparison = compare_surfaces(cube().view(), cube().moved({0.1, 0.0, 0.0}).view(), 60'000);
    const DistanceSummary d = comparison.a.distance;
    // All of the face in front; of the four at the sides a strip, 0.1 down to 0; of the face behind, which is inside
    // the other cube, what is not nearer to one of the other's sides.
    const double front = 0.01;
    const double strips = 4.0 * 0.001 / 3.0;
    const double behind = 0.64 * 0.01 + 4.0 * 0.001 / 3.0 - 8.0 * 0.0001 / 4.0;
    EXPECT_NEAR(d.max, 0.1, 1e-12);
    EXPECT_NEAR(d.percentile_99, 0.1, 1e-12);
    EXPECT_NEAR(d.rms, std::sqrt((front + strips + behind) / 6.0), 2e-4);
}

TEST(Comparison, PercentilesAreOfTheAreaNotOfTheSamples) {
    // A plane of area 100, and many specks off it: few of the area, most of the samples.
    const Shape plane = square().moved({0.0, 0.0, 0.0}, 10.0);
    const auto with_specks = [&](double area) {
        Shape out = plane;
        for (int i = 0; i < 100; ++i) out.add(square(), {5.0, 5.0, 1.0}, std::sqrt(area / 100.0));
        return out;
    };
    const Shape few = with_specks(0.9);
    const Shape more = with_specks(1.1);
    EXPECT_NEAR(compare_surfaces(few.view(), plane.view(), 1000).a.distance.percentile_99, 0.0, 1e-12);
    EXPECT_DOUBLE_EQ(compare_surfaces(more.view(), plane.view(), 1000).a.distance.percentile_99, 1.0);
    EXPECT_NEAR(compare_surfaces(more.view(), plane.view(), 1000).a.distance.rms, std::sqrt(1.1 / 101.1), 1e-9);
}

TEST(Comparison, AMissingComponentIsLostAndAnAddedOneGained) {
    const Shape one = cube();
    const Shape two = cube().add(cube(), {7.0, 0.0, 0.0}, 0.01);
    const Comparison lost = compare_surfaces(one.view(), two.view(), 1000);
    ASSERT_EQ(lost.b.missing(1.0).size(), 1U);
    EXPECT_TRUE(lost.a.missing(1.0).empty());
    EXPECT_EQ(lost.b.missing(1.0)[0].triangles, 12U);
    EXPECT_NEAR(lost.b.missing(1.0)[0].center[0], 7.005, 0.005);
    EXPECT_NEAR(lost.b.farthest_part(), 6.0, 0.01);
    const Comparison gained = compare_surfaces(two.view(), one.view(), 1000);
    EXPECT_EQ(gained.a.missing(1.0).size(), 1U);
    EXPECT_TRUE(gained.b.missing(1.0).empty());
}

TEST(Comparison, AComponentIsMissingBeyondThreeQuartersOfACell) {
    const Comparison comparison = compare_surfaces(square().view(), square().moved({0.0, 0.0, 0.3}).view(), 1000);
    EXPECT_TRUE(comparison.b.missing(0.401).empty());
    EXPECT_EQ(comparison.b.missing(0.399).size(), 1U);
}

TEST(Comparison, AComponentThatIsNearInOnePlaceIsNotMissing) {
    // A long needle, one end of which touches the cube.
    const Shape needle{{{1, 0.5, 0.5}, {9, 0.5, 0.5}, {9, 0.6, 0.5}}, {{0, 1, 2}}};
    const Shape both = cube().add(needle);
    EXPECT_TRUE(compare_surfaces(cube().view(), both.view(), 5000).b.missing(2.0).empty());
}

TEST(Comparison, AgreesWithAllPairsOnRandomMeshes) {
    std::mt19937 random(4);
    for (int round = 0; round < 5; ++round) {
        const Shape a = random_triangles(random, 60);
        const Shape b = random_triangles(random, 40);
        const Comparison comparison = compare_surfaces(a.view(), b.view(), 500);
        const Components components = find_components(a.view());
        const Samples samples = sample(a.view(), components, 500);
        double squares = 0.0;
        double max = 0.0;
        std::vector<double> nearest(components.count(), std::numeric_limits<double>::infinity());
        for (std::size_t k = 0; k < components.count(); ++k)
            for (std::size_t i = samples.starts[k]; i < samples.starts[k + 1]; ++i) {
                double square = std::numeric_limits<double>::infinity();
                for (const Triangle& t : b.triangles)
                    square = std::min(square, squared_distance(samples.points[i], b.view().corners(t)));
                squares += samples.weights[i] * square;
                max = std::max(max, std::sqrt(square));
                nearest[k] = std::min(nearest[k], std::sqrt(square));
            }
        EXPECT_NEAR(comparison.a.distance.rms, std::sqrt(squares / samples.area()), 1e-12);
        EXPECT_EQ(comparison.a.distance.max, max);
        ASSERT_EQ(comparison.a.parts.size(), nearest.size());
        for (std::size_t k = 0; k < nearest.size(); ++k) EXPECT_EQ(comparison.a.parts[k].distance, nearest[k]);
    }
}

TEST(Comparison, TheSameFiguresEveryTime) {
    std::mt19937 random(5);
    const Shape a = random_triangles(random, 50);
    const Shape b = random_triangles(random, 50);
    const Comparison first = compare_surfaces(a.view(), b.view(), 1000);
    const Comparison second = compare_surfaces(a.view(), b.view(), 1000);
    EXPECT_EQ(first.distance().rms, second.distance().rms);
    EXPECT_EQ(first.distance().percentile_99, second.distance().percentile_99);
    EXPECT_EQ(first.distance().max, second.distance().max);
}

TEST(Comparison, WhatCannotBeComparedIsRefused) {
    const auto refused = [](const Shape& shape) { EXPECT_THROW(validate(shape.view(), "mesh"), InvalidInput); };
    refused({});
    refused({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
    refused(cube().moved({1e61, 0.0, 0.0}));
    EXPECT_NO_THROW(validate(cube().moved({1e59, 0.0, 0.0}, 1e58).view(), "mesh"));
}

}  // namespace
}  // namespace meniscus::compare
