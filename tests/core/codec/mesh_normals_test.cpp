// Normals that are computed from triangles: known ones, and those of a slow way to compute them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/has_draco.hpp"
#include "support/noise.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

using Vector = std::array<double, 3>;

/// ordinary, crack: triangles over the vertices.
Mesh mesh_of(const std::vector<LatticePosition>& vertices, const std::vector<Triangle>& ordinary,
             const std::vector<Triangle>& crack = {}) {
    Mesh mesh;
    mesh.cell_size = 1.0;
    mesh.offset_bits = 6;
    mesh.vertices.assign(vertices.begin(), vertices.end());
    mesh.triangles.assign(ordinary.begin(), ordinary.end());
    mesh.triangles.insert(mesh.triangles.end(), crack.begin(), crack.end());
    const auto count = static_cast<std::uint32_t>(ordinary.size());
    mesh.levels = {{{0, 0}, {0, 0}, {0, count}, {count, static_cast<std::uint32_t>(crack.size())}}};
    return mesh;
}

std::vector<Normal> normals_of(Mesh mesh) {
    compute_normals(mesh);
    return {mesh.normals.begin(), mesh.normals.end()};
}

void expect_near(const Normal& normal, const Vector& expected, double tolerance, const std::string& what) {
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(normal[k], expected[k], tolerance) << what;
}

/// A fan of four unequal triangles around vertex 0, in the plane of normal (2, 1, 2) / 3.
const std::vector<LatticePosition> fan_vertices{{0, 0, 0}, {5, 0, -5}, {0, 14, -7}, {-9, 2, 8}, {1, -40, 19}};
const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};

TEST(MeshNormals, OfAPlaneAreThePlanes) {
    for (const Normal& normal : normals_of(mesh_of(fan_vertices, fan)))
        expect_near(normal, {2.0 / 3, 1.0 / 3, 2.0 / 3}, 1e-7, "plane");
}

TEST(MeshNormals, OfASphereAreItsRadiiHoweverUnequalTheTriangles) {
    // Circles of latitude and longitude at random distances: area or angle weights would be degrees off.
    constexpr int rings = 12;
    constexpr int columns = 17;
    constexpr double radius = 1 << 16;
    constexpr double pi = 3.14159265358979323846;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> wide(0.2, 1.8);
    const auto steps = [&](int count, double whole) {
        std::vector<double> at;
        double sum = 0.0;
        at.reserve(static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i) at.push_back(sum += wide(random));
        for (double& a : at) a *= whole / sum;
        return at;
    };
    const std::vector<double> latitudes = steps(rings + 1, pi);
    const std::vector<double> longitudes = steps(columns, 2.0 * pi);
    std::vector<LatticePosition> vertices{{0, 0, static_cast<std::int32_t>(radius)}};
    const auto rounded = [](double x) { return static_cast<std::int32_t>(std::lround(x)); };
    for (int r = 0; r < rings; ++r)
        for (const double b : longitudes) {
            const double a = latitudes[static_cast<std::size_t>(r)];
            vertices.push_back({rounded(radius * std::sin(a) * std::cos(b)),
                                rounded(radius * std::sin(a) * std::sin(b)), rounded(radius * std::cos(a))});
        }
    vertices.push_back({0, 0, -static_cast<std::int32_t>(radius)});
    const auto at = [](int r, int c) { return static_cast<std::uint32_t>(1 + r * columns + c % columns); };
    std::vector<Triangle> triangles;
    for (int c = 0; c < columns; ++c) {
        triangles.push_back({0, at(0, c), at(0, c + 1)});
        for (int r = 0; r + 1 < rings; ++r) {
            triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
            triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
        }
        triangles.push_back({at(rings - 1, c), static_cast<std::uint32_t>(vertices.size() - 1), at(rings - 1, c + 1)});
    }
    const std::vector<Normal> normals = normals_of(mesh_of(vertices, triangles));
    ASSERT_EQ(normals.size(), vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        Vector expected;
        for (std::size_t k = 0; k < 3; ++k) expected[k] = vertices[v][k] / radius;
        expect_near(normals[v], expected, 2e-3, "vertex " + std::to_string(v));  // what is left is of rounded places
    }
}

TEST(MeshNormals, AreNotMovedByTrianglesWithoutAnArea) {
    std::vector<LatticePosition> vertices = fan_vertices;
    vertices.push_back({100, 100, 100});  // 5: of such triangles alone
    vertices.push_back({102, 102, 102});
    vertices.push_back({107, 107, 107});
    std::vector<Triangle> triangles = fan;
    for (const Triangle& flat : std::vector<Triangle>{{0, 0, 1}, {1, 0, 1}, {2, 2, 2}, {5, 6, 7}, {5, 5, 0}, {0, 5, 5}})
        triangles.push_back(flat);
    const std::vector<Normal> normals = normals_of(mesh_of(vertices, triangles));
    const std::vector<Normal> before = normals_of(mesh_of(fan_vertices, fan));
    for (std::size_t v = 0; v < before.size(); ++v) EXPECT_EQ(normals[v], before[v]);
    for (std::size_t v = before.size(); v < normals.size(); ++v) EXPECT_EQ(normals[v], (Normal{0.0F, 0.0F, 1.0F}));
}

TEST(MeshNormals, LeaveCrackFillingOutUnlessThereIsNothingElse) {
    std::vector<LatticePosition> vertices = fan_vertices;
    vertices.push_back({0, 0, 9});  // 5: of crack filling alone, in the plane x = 0
    const std::vector<Triangle> crack{{0, 2, 5}, {0, 5, 2}, {0, 2, 5}};
    const std::vector<Normal> normals = normals_of(mesh_of(vertices, fan, crack));
    const std::vector<Normal> before = normals_of(mesh_of(fan_vertices, fan));
    for (std::size_t v = 0; v < before.size(); ++v) EXPECT_EQ(normals[v], before[v]);
    EXPECT_EQ(normals[5], (Normal{1.0F, 0.0F, 0.0F}));
}

TEST(MeshNormals, OfAnEmptyMeshAreNone) {
    EXPECT_TRUE(normals_of(Mesh{}).empty());
}

/// The sum over the triangles at a vertex, and the sum of the lengths of the summands.
struct Oracle {
    std::vector<Vector> sums;
    std::vector<double> lengths;
};

Oracle oracle(const Mesh& mesh, bool filling) {
    Oracle found{std::vector<Vector>(mesh.vertices.size()), std::vector<double>(mesh.vertices.size())};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if ((mesh.level_of(t) == TriangleLevel::crack) != filling) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t v = mesh.triangles[t][i];
            const LatticePosition& a = mesh.vertices[v];
            const LatticePosition& b = mesh.vertices[mesh.triangles[t][(i + 1) % 3]];
            const LatticePosition& c = mesh.vertices[mesh.triangles[t][(i + 2) % 3]];
            const Vector e{double(b[0]) - a[0], double(b[1]) - a[1], double(b[2]) - a[2]};
            const Vector g{double(c[0]) - a[0], double(c[1]) - a[1], double(c[2]) - a[2]};
            const double weight =
                1.0 / (std::pow(std::hypot(e[0], e[1], e[2]), 2) * std::pow(std::hypot(g[0], g[1], g[2]), 2));
            const Vector part{(e[1] * g[2] - e[2] * g[1]) * weight, (e[2] * g[0] - e[0] * g[2]) * weight,
                              (e[0] * g[1] - e[1] * g[0]) * weight};
            for (std::size_t k = 0; k < 3; ++k) found.sums[v][k] += part[k];
            found.lengths[v] += std::hypot(part[0], part[1], part[2]);
        }
    }
    return found;
}

test::NoiseWorld noise(bool uniform) {
    test::NoiseWorld world;
    world.share = 0.4;
    world.uniform = uniform;
    world.first = -3;  // over the faces of eight bricks
    return world;
}

TEST(MeshNormals, AreThoseOfANaiveSumOnWhiteNoise) {
    std::size_t compared = 0;
    for (const bool uniform : {false, true})
        test::for_each_seed(noise(uniform), 900, 20, [&](const test::NoiseWorld& world) {
            Mesh mesh = test::mesh_of_noise_on_cpu(world);
            ASSERT_FALSE(mesh.triangles.empty());
            compute_normals(mesh);
            ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
            const Oracle ordinary = oracle(mesh, false);
            const Oracle crack = oracle(mesh, true);
            for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
                const Oracle& of = ordinary.lengths[v] > 0.0 ? ordinary : crack;
                const Vector& sum = of.sums[v];
                const double length = std::hypot(sum[0], sum[1], sum[2]);
                // Of parts that cancel each other out rounding is all that is left.
                if (length < 1e-5 * of.lengths[v]) continue;
                expect_near(mesh.normals[v], {sum[0] / length, sum[1] / length, sum[2] / length}, 1e-5, "vertex");
                ++compared;
            }
        });
    EXPECT_GT(compared, 10000U);
}

TEST(MeshNormals, AreTheSameToTheBitInEveryOrderOfTheTriangles) {
    Mesh mesh = test::mesh_of_noise_on_cpu(noise(false));
    const std::vector<Normal> expected = normals_of(mesh);
    std::mt19937 random(3);
    for (const TriangleRange& range : mesh.levels) {
        const auto first = mesh.triangles.begin() + range.first;
        std::shuffle(first, first + range.count, random);
        for (auto t = first; t != first + range.count; ++t)
            std::rotate(t->begin(), t->begin() + static_cast<std::ptrdiff_t>(random() % 3), t->end());
    }
    EXPECT_EQ(normals_of(mesh), expected);
}

TEST(MeshNormals, AreTheSameToTheBitThroughEveryCodec) {
    if (!test::has_draco()) GTEST_SKIP() << "this build has no Draco";
    const auto particles = test::splash(64);
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings settings = test::default_settings();
        settings.mode = mode;
        settings.cell_size = 0.4;
        BackendOptions place{.backend = Backend::cpu, .threads = 1};
        place.keep_lattice = true;
        Mesh mesh;
        Reconstructor(settings, place).reconstruct(particles.frame(), mesh);
        ASSERT_GT(mesh.bricks.size(), 1U);
        const auto in_order = [](Mesh with_normals) {
            compute_normals(with_normals);
            put_in_canonical_order(with_normals);
            return with_normals.normals;
        };
        const auto expected = in_order(mesh);
        for (const Codec codec : codecs) {
            std::vector<DecodedBrick> bricks;
            for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
                bricks.push_back(
                    decode_brick(encode_brick(mesh, b, {.normal_bits = 0, .codec = codec}), mesh.offset_bits));
            const Mesh welded = weld_bricks(bricks, mesh.cell_size, mesh.offset_bits);
            ASSERT_TRUE(welded.normals.empty());
            EXPECT_EQ(in_order(welded), expected) << name_of(codec);
        }
    }
}

}  // namespace
}  // namespace meniscus
