// The promise of a closed 2-manifold does not depend on the field: here it is white noise over random levels.
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <memory>
#include <random>
#include <vector>

#include "engine/cpu/clusters.hpp"
#include "engine/cpu/surface.hpp"
#include "meniscus/mesh.hpp"
#include "support/mesh_check.hpp"

namespace meniscus {
namespace {

/// White noise at lattice points strictly inside a box of base cells, zero at its border and beyond.
class NoiseField final : public cpu::FieldSource {
public:
    NoiseField(std::uint64_t seed, int side, double inside_share, bool many_ties)
        : seed_(seed), side_(side), share_(inside_share), ties_(many_ties) {}

    void values(const Int3& base_cell, cpu::PointList& points, float* out, unsigned) override {
        for (std::size_t i = 0; i < points.count; ++i) out[i] = value(base_cell, points.x[i], points.y[i], points.z[i]);
    }
    void cluster_values(const Int3& lowest_base_cell, const cpu::ClusterPoints& points, cpu::ClusterValues& out,
                        unsigned) override {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (BlockMask left = points[i]; left != 0; left &= left - 1) {
                const int bit = lowest_bit(left);
                const auto coordinate = [bit](int axis) {
                    return static_cast<float>(point_coordinate(bit, axis) * units_per_cell);
                };
                out[i][static_cast<std::size_t>(bit)] = value(lowest_base_cell + cpu::cluster_step(static_cast<int>(i)),
                                                              coordinate(0), coordinate(1), coordinate(2));
            }
    }
    void normals(const Int3&, cpu::PointList& points, float* x, float* y, float* z, unsigned) override {
        for (std::size_t i = 0; i < points.count; ++i) x[i] = y[i] = z[i] = std::nanf("");
    }

private:
    float value(const Int3& b, float px, float py, float pz) const {
        const std::int64_t p[3] = {b.x * std::int64_t{units_per_base_cell} + static_cast<std::int64_t>(px),
                                   b.y * std::int64_t{units_per_base_cell} + static_cast<std::int64_t>(py),
                                   b.z * std::int64_t{units_per_base_cell} + static_cast<std::int64_t>(pz)};
        std::uint64_t h = seed_;
        for (const std::int64_t c : p) {
            if (c <= 0 || c >= std::int64_t{side_} * units_per_base_cell) return 0.0F;
            h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15ULL;
            h ^= h >> 29;
        }
        const double uniform = static_cast<double>(h >> 11) * 0x1p-53;
        // The iso-value is 1. With ties, many values lie exactly on it.
        if (ties_ && (h & 7) < 3) return 1.0F;
        return uniform < share_ ? 1.0F + static_cast<float>(uniform) : static_cast<float>(uniform) * 0.9F;
    }

    std::uint64_t seed_;
    int side_;
    double share_;
    bool ties_;
};

struct World {
    int side = 5;
    double share = 0.5;
    bool ties = false;
    bool uniform = false;
    EdgePoints edge_points = Interpolation{};
    bool raise_at_slivers = true;
    int max_level = 3;        ///< of the levels from which the mesh is emitted
    double band_share = 1.0;  ///< base cells that start in the band; the others must join where the samples say so
};

Mesh mesh_of_noise(std::uint64_t seed, const World& world) {
    Settings user;
    user.particle_radius = 1.0;
    user.iso = 1.0;
    user.edge_points = world.edge_points;
    const LatticeSettings settings(user);
    auto account = std::make_shared<MemoryAccount>();
    cpu::Workers workers(1);
    cpu::Surface surface(account, workers, settings);
    std::mt19937_64 random(seed);
    NoiseField field(seed, world.side, world.share, world.ties);

    surface.grid.bricks.resize(1);
    Brick& brick = surface.grid.bricks[0];
    brick.coordinate = {};
    brick.clear();
    surface.grid.keys.assign(1, brick_key(brick.coordinate));
    for (int z = 0; z < world.side; ++z)
        for (int y = 0; y < world.side; ++y)
            for (int x = 0; x < world.side; ++x) {
                const int index = index_in_brick({x, y, z});
                brick.occupied[index >> 6] |= std::uint64_t{1} << (index & 63);
            }
    cpu::number_members(surface.grid, workers);
    cpu::store_blocks(surface);
    std::uniform_int_distribution<int> level(1, 3);
    std::vector<std::uint8_t> wanted_level(surface.block_count());
    for (std::uint32_t b = 0; b < surface.block_count(); ++b) {
        wanted_level[b] = static_cast<std::uint8_t>(world.uniform ? 3 : level(random));
        surface.wanted_points[b] = 1;
    }
    surface.chosen.assign(std::begin(brick.occupied), std::end(brick.occupied));
    cpu::sample_wanted_points(surface, field, cpu::Wanted::corners);
    // As in the pipeline, a cell may start outside the band only if its corners agree.
    std::bernoulli_distribution starts(world.band_share);
    const BlocksView blocks = surface.view();
    for (std::uint32_t b = 0; b < surface.block_count(); ++b) {
        const ClosedCell cell(blocks, b);
        int inside = 0;
        for (const std::uint32_t corner : cell.block) inside += static_cast<int>(blocks.inside_or_none(corner) & 1);
        const bool agree = inside == 0 || inside == 8;
        surface.level[b] = !agree || starts(random) ? wanted_level[b] : std::uint8_t{0};
    }
    Mesh mesh;
    mesh.cell_size = settings.cell_size;
    mesh.offset_bits = settings.offset_bits;
    cpu::levels_are_new(surface);
    if (!world.uniform) cpu::adjust_levels(surface);
    const auto joining_level = [&](std::uint32_t block) { return wanted_level[block]; };
    if (world.raise_at_slivers) {
        cpu::sample_field(surface, field, joining_level);
    } else {
        // Keeps the faces whose cracks only the fine side sees: the patterns must close them too.
        do {
            cpu::adjust_levels(surface);
            cpu::sample_corner_points(surface, field);
        } while (cpu::grow_band(surface, joining_level));
    }
    cpu::sample_edge_middles(surface, field);
    if (world.max_level < 3) {
        Array<std::uint8_t> levels;
        levels.assign(surface.level.begin(), surface.level.end());
        cpu::cap_levels(surface, levels, world.max_level);
    }
    cpu::count_triangles(surface, mesh);
    cpu::place_vertices(surface, field, user, mesh);
    cpu::emit_triangles(surface, mesh);
    cpu::fill_cracks(surface, mesh);
    return mesh;
}

void expect_closed(const World& world, std::uint64_t first, std::uint64_t count) {
    std::size_t triangles = 0;
    std::size_t cracks = 0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Mesh mesh = mesh_of_noise(seed, world);
        const test::MeshReport report = test::check(mesh);
        ASSERT_TRUE(report.closed_manifold()) << "seed " << seed << ": " << report.text();
        triangles += mesh.triangles.size();
        cracks += mesh.levels[3].count;
    }
    EXPECT_GT(triangles, 100 * count);
    if (!world.uniform && world.max_level > 1) {
        EXPECT_GT(cracks, 10 * count);
    }
}

TEST(WhiteNoise, GivesClosedManifoldsOverRandomLevels) {
    expect_closed({.raise_at_slivers = false}, 1, 500);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereSliversAreRaised) {
    expect_closed({}, 7001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereFewPointsAreInside) {
    expect_closed({.share = 0.15, .raise_at_slivers = false}, 1001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereFewPointsAreOutside) {
    expect_closed({.share = 0.85, .raise_at_slivers = false}, 2001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereValuesLieOnTheIsoValue) {
    expect_closed({.ties = true, .raise_at_slivers = false}, 3001, 100);
}
TEST(WhiteNoise, GivesClosedManifoldsWhenTheBandMustGrow) {
    expect_closed({.share = 0.02, .raise_at_slivers = false, .band_share = 0.1}, 4001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereLevelsAreCapped) {
    for (const int max_level : {1, 2}) expect_closed({.raise_at_slivers = false, .max_level = max_level}, 8001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsInUniformMode) {
    expect_closed({.side = 3, .uniform = true}, 5001, 50);
}
TEST(WhiteNoise, GivesClosedManifoldsWithBisection) {
    expect_closed({.edge_points = Bisection{}}, 6001, 50);
}

}  // namespace
}  // namespace meniscus
