// The adaptive surface against the uniform one: near everywhere, and nothing lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "compare/comparison.hpp"
#include "field/cubic_spline.hpp"
#include "meniscus/mesh.hpp"
#include "steps/place_vertices/coarse_edges.hpp"
#include "steps/split_cells/curvature.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

std::vector<compare::Point> world_positions(const Mesh& mesh) {
    std::vector<compare::Point> positions;
    for (const LatticePosition& p : mesh.vertices) positions.push_back(mesh.world(p));
    return positions;
}

/// The comparison of the adaptive surface (a) and the uniform one (b).
compare::Comparison compare_modes(const test::Particles& particles, Field field, double tolerance) {
    Settings settings = test::default_settings();
    settings.field = field;
    settings.criterion = CurvatureCriterion{tolerance};
    const Mesh adaptive = test::reconstruct(settings, particles.frame());
    settings.mode = Mode::uniform;
    const Mesh uniform = test::reconstruct(settings, particles.frame());
    const std::vector<compare::Point> a = world_positions(adaptive), b = world_positions(uniform);
    return compare::compare_surfaces({a, adaptive.triangles}, {b, uniform.triangles}, 20'000);
}

double cell_size() {
    return world_cell_size(test::default_settings());
}

/// Drops too far apart to meet, anywhere between the lattice's points.
test::Particles lone_drops(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> offset(0.0F, 4.0F);
    test::Particles particles;
    for (int i = 0; i < 64; ++i) {
        const int row = i / 4;
        const int layer = row / 4;
        const float x = static_cast<float>(i % 4 * 10) + offset(random);
        const float y = static_cast<float>(row % 4 * 10) + offset(random);
        const float z = static_cast<float>(layer * 10) + offset(random);
        particles.add(0.025F * x, 0.025F * y, 0.025F * z);
    }
    return particles;
}

/// A block of particles just far enough apart that the field between them is near the iso-value: small holes all over.
test::Particles loose_block(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> jitter(-0.3F, 0.3F);
    const float spacing = 2.2F * 0.025F;
    test::Particles particles;
    for (int i = 0; i < 1000; ++i) {
        const int row = i / 10;
        const int layer = row / 10;
        const float x = static_cast<float>(i % 10) + jitter(random);
        const float y = static_cast<float>(row % 10) + jitter(random);
        const float z = static_cast<float>(layer) + jitter(random);
        particles.add(spacing * x, spacing * y, spacing * z);
    }
    return particles;
}

test::Particles random_cloud(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(0.0F, 0.4F);
    test::Particles particles;
    for (int i = 0; i < 200; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        particles.add(x, y, z);
    }
    return particles;
}

void expect_near(const test::Particles& particles) {
    for (const Field field : {Field::color, Field::smooth}) {
        SCOPED_TRACE(name_of(field));
        const compare::DistanceSummary distance = compare_modes(particles, field, 0.15).distance();
        // The distances of a smooth drop are all alike: its curvature is the same everywhere.
        EXPECT_LE(distance.rms, (field == Field::smooth ? 0.15 : 0.1) * cell_size());
        EXPECT_LE(distance.percentile_99, 0.25 * cell_size());
    }
}

TEST(Adaptivity, LoneDropsAreNearTheUniformOnesWhereverTheyLie) {
    for (unsigned seed = 0; seed < 4; ++seed) expect_near(lone_drops(seed));
}

TEST(Adaptivity, ACubeOfEightDropsIsNearTheUniformOneWhereverItLies) {
    for (int shift = 0; shift < 8; ++shift) {
        test::Particles cube;
        for (int i = 0; i < 8; ++i) {
            const float at = 0.0125F * static_cast<float>(shift);
            cube.add(0.05F * static_cast<float>(i & 1) + at, 0.05F * static_cast<float>(i >> 1 & 1) + at,
                     0.05F * static_cast<float>(i >> 2) + at);
        }
        SCOPED_TRACE(shift);
        expect_near(cube);
    }
}

void expect_nothing_lost(const test::Particles& particles) {
    for (const Field field : {Field::color, Field::smooth}) {
        SCOPED_TRACE(name_of(field));
        const compare::Comparison comparison = compare_modes(particles, field, 0.25);
        EXPECT_TRUE(comparison.b.missing(cell_size()).empty());
        EXPECT_TRUE(comparison.a.defects.closed());
    }
}

/// Groups of some particles, far from each other, in rows.
TEST(Adaptivity, NoGroupIsLostWhateverTheThreshold) {
    std::mt19937 random(12);
    std::uniform_real_distribution<float> spacing(0.0F, 0.06F), offset(0.0F, 0.05F);
    test::Particles particles;
    std::size_t groups = 0;
    for (int size = 2; size <= 5; ++size)
        for (int i = 0; i < 9; ++i, ++groups) {
            const float step = spacing(random);
            const float x = 0.6F * static_cast<float>(i) + offset(random), y = 0.6F * static_cast<float>(size);
            for (int j = 0; j < size; ++j) particles.add(x + step * static_cast<float>(j), y, offset(random) * 0.2F);
        }
    for (const std::uint32_t smoothness : {5U, 6U, 7U})
        for (const double iso : {0.6, 0.75, 0.9})
            for (const Mode mode : choices<Mode>) {
                Settings settings = test::default_settings();
                settings.smoothness = smoothness;
                settings.iso = iso;
                settings.mode = mode;
                const test::MeshReport report = test::check(test::reconstruct(settings, particles.frame()));
                EXPECT_TRUE(report.closed_manifold()) << report.text();
                EXPECT_GE(report.components, groups) << smoothness << ", " << iso << ", " << name_of(mode);
            }
}

TEST(Adaptivity, NoPartOfARandomCloudIsLost) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        SCOPED_TRACE(seed);
        expect_nothing_lost(random_cloud(seed));
    }
}

TEST(Adaptivity, NoHoleOfALooseBlockIsLost) {
    for (const unsigned seed : {1U, 20U, 79U, 215U}) {
        SCOPED_TRACE(seed);
        expect_nothing_lost(loose_block(seed));
    }
}

/// Searches a cell at the origin for a plane across x, units; returns whether it looked twice.
bool looks_again(float plane, bool corners_are_mixed) {
    const float iso = 0.6F;
    int looks = 0;
    const auto jet_at = [&](const Point3<float>& p) {
        ++looks;
        FieldJet<float> jet;
        jet.x = -1e-5F;
        jet.value = iso + jet.x * (p.x - plane);
        return jet;
    };
    CellCorners<float> corners;
    for (int i = 0; i < 8; ++i) corners.value[i] = -1e-5F * (static_cast<float>((i & 1) * units_per_base_cell) - plane);
    const SurfaceSearch<float> found = search_surface(corners, corners_are_mixed ? 1.0F : 0.0F, {0.0F, 0.0F, 0.0F}, iso,
                                                      jet_at, [](float again) { return again == 1.0F; });
    EXPECT_EQ(looks, found.again == 1.0F ? 2 : 1);
    EXPECT_NEAR(found.inside, std::min(plane, static_cast<float>(units_per_base_cell) - plane), 16.0F);
    return looks == 2;
}

TEST(Adaptivity, ACellIsLookedAtTwiceWhereItsCornersAgreeAndTheSurfaceIsNear) {
    constexpr float edge = units_per_base_cell;
    EXPECT_FALSE(looks_again(0.3F * edge, true));
    for (const float beyond : {0.4F, 0.1F, -0.3F * base_cell_size}) {
        EXPECT_TRUE(looks_again(edge + beyond * units_per_cell, false)) << beyond;
        EXPECT_TRUE(looks_again(-beyond * units_per_cell, false)) << beyond;
    }
    for (const float beyond : {0.6F, 3.0F, 40.0F}) {
        EXPECT_FALSE(looks_again(edge + beyond * units_per_cell, false)) << beyond;
        EXPECT_FALSE(looks_again(-beyond * units_per_cell, false)) << beyond;
    }
}

/// A ball of radius `radius`, in particle radii, filled by a lattice of particles.
test::Particles ball(float radius) {
    test::Particles particles;
    const int most = static_cast<int>(radius) / 2;
    for (int z = -most; z <= most; ++z)
        for (int y = -most; y <= most; ++y)
            for (int x = -most; x <= most; ++x)
                if (static_cast<float>(4 * (x * x + y * y + z * z)) <= radius * radius)
                    particles.add(0.05F * static_cast<float>(x), 0.05F * static_cast<float>(y),
                                  0.05F * static_cast<float>(z));
    return particles;
}

/// Chords of coarse cells cut off what lies beyond them.
TEST(Adaptivity, ABallOfCoarseCellsKeepsMostOfWhatChordsCutOff) {
    Settings settings = test::default_settings();
    settings.field = Field::smooth;
    settings.criterion = CurvatureCriterion{1000.0};
    const auto volume = [&] { return test::check(test::reconstruct(settings, ball(14.0F).frame())).volume; };
    const double moved = volume();
    settings.edge_points = Bisection{};  // whose vertices are not moved
    const double on_the_surface = volume();
    settings.mode = Mode::uniform;
    const double whole = volume();
    EXPECT_LT(on_the_surface, 0.993 * whole);
    EXPECT_NEAR(moved / whole, 1.0, 0.004);
}

/// The shift of an edge along x whose cells are, in the order of LevelsAround's indices, these.
float shift_along_x(int bit, const std::array<CellAtEdge, 8>& cells) {
    return iso_shift(0, bit, [&](int i) { return cells[static_cast<std::size_t>(i)]; });
}

CellAtEdge cell_at_edge(int level, float trace) {
    CellAtEdge cell;
    cell.level = level;
    cell.trace = trace;
    return cell;
}

TEST(CoarseEdges, AVertexTakesTheMeanTraceOfTheCellsThatHaveItsEdge) {
    // Along x: the own cell, those below along y (2) and z (4), and along both (6).
    const std::array<CellAtEdge, 8> cells{cell_at_edge(1, 0.5F),  {}, cell_at_edge(1, 0.0F), {},
                                          cell_at_edge(1, -1.5F), {}, cell_at_edge(0, 0.0F), {}};
    EXPECT_FLOAT_EQ(shift_along_x(point_bit(0, 0, 0), cells), 0.05F * 16.0F * -0.5F);
    EXPECT_FLOAT_EQ(shift_along_x(point_bit(0, 0, 2), cells), 0.05F * 16.0F * 0.5F);
    EXPECT_FLOAT_EQ(shift_along_x(point_bit(0, 2, 0), cells), 0.05F * 16.0F * -0.5F);
    EXPECT_FLOAT_EQ(shift_along_x(point_bit(0, 2, 2), cells), 0.05F * 16.0F * 0.5F);
}

TEST(CoarseEdges, AVertexIsMovedByTheFinestCellThatHasItsEdge) {
    std::array<CellAtEdge, 8> cells{cell_at_edge(1, 1.0F), {}, cell_at_edge(2, 1.0F)};
    EXPECT_FLOAT_EQ(shift_along_x(point_bit(0, 0, 0), cells), 0.05F * 4.0F);
    cells[4] = cell_at_edge(3, 1.0F);
    EXPECT_EQ(shift_along_x(point_bit(0, 0, 0), cells), 0.0F);
    EXPECT_FLOAT_EQ(shift_along_x(point_bit(0, 0, 1), cells), 0.05F * 4.0F);
    EXPECT_EQ(shift_along_x(point_bit(0, 1, 1), {}), 0.0F);
}

TEST(Adaptivity, ADropsCurvatureIsToldFromOutsideOfIt) {
    const float support = 8.0F * units_per_cell;
    const float radius = 0.28F * support;
    const auto jet_at = [&](float distance) {
        FieldJet<float> jet;
        CubicSpline{1.0F, 1.0F / support}.add_jet(jet, 0.6F * distance, 0.8F * distance, 0.0F);
        return jet;
    };
    const float iso = jet_at(radius).value;
    for (int tenths = 7; tenths <= 16; ++tenths) {
        const float distance = 0.1F * static_cast<float>(tenths) * radius;
        EXPECT_NEAR(surface_bend(jet_at(distance), iso).curvature * radius, 2.0F, 0.2F) << distance / radius;
    }
}

}  // namespace
}  // namespace meniscus
