// Attributes of the vertices: means of the particles' values by the field's own weights, and ids.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/instruction_set.hpp"
#include "meniscus/meniscus.hpp"
#include "support/attributes.hpp"
#include "support/naive_field.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

Settings with_all(Settings settings = test::default_settings()) {
    settings.all_attributes = true;
    return settings;
}

Mesh mesh_of(const Settings& settings, test::ParticlesWithArrays& particles, unsigned threads = 1) {
    return test::reconstruct(settings, particles.frame(), threads);
}

/// Every field in every mode, with and without normals, by both ways to find vertices.
template <class Visit>
void for_each_kind(const Visit& visit) {
    for (const Field field : choices<Field>)
        for (const bool adaptive : {true, false}) {
            Settings settings = with_all();
            settings.field = field;
            settings.mode = adaptive ? Mode::adaptive : Mode::uniform;
            settings.normals = adaptive;
            if (!adaptive) settings.edge_points = Bisection{3};
            SCOPED_TRACE(testing::Message() << name_of(field) << ", " << name_of(settings.mode));
            visit(settings);
        }
}

/// Means within rounding, and ids of particles whose shares are the largest within rounding.
void expect_naive_means(const Settings& settings, const test::ParticlesWithArrays& particles, const Mesh& mesh) {
    const test::NaiveField naive(settings, particles.particles);
    const std::size_t n = particles.particles.count();
    ASSERT_EQ(mesh.attributes.size(), particles.arrays.size());
    ASSERT_GT(mesh.vertices.size(), 100U);
    std::vector<double> share(n);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += 1 + mesh.vertices.size() / 300) {
        const auto p = mesh.world(mesh.vertices[v]);
        double total = 0.0, largest_share = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            share[i] = naive.share(i, p[0], p[1], p[2]);
            total += share[i];
            largest_share = std::max(largest_share, share[i]);
        }
        ASSERT_GT(total, 0.0);
        for (std::size_t a = 0; a < particles.arrays.size(); ++a) {
            const MeshAttribute& attribute = mesh.attributes[a];
            ASSERT_EQ(attribute.name, particles.names[a]);
            ASSERT_EQ(attribute.data.size(), mesh.vertices.size() * attribute.element_bytes());
            if (is_id(attribute.type)) {
                const auto id = test::vertex_value<std::uint32_t>(attribute, v);
                double of_id = 0.0;
                for (std::size_t i = 0; i < n; ++i)
                    if (particles.value<std::uint32_t>(a, i, 0) == id) of_id = std::max(of_id, share[i]);
                EXPECT_GT(of_id, largest_share * 0.9999) << attribute.name << ", vertex " << v;
                continue;
            }
            for (std::size_t c = 0; c < attribute.components; ++c) {
                const bool is_byte = attribute.type == ElementType::uint8;
                double mean = 0.0;
                for (std::size_t i = 0; i < n; ++i)
                    mean += share[i] / total *
                            (is_byte ? static_cast<double>(particles.value<std::uint8_t>(a, i, c))
                                     : static_cast<double>(particles.value<float>(a, i, c)));
                if (is_byte)
                    EXPECT_NEAR(test::vertex_value<std::uint8_t>(attribute, v, c), mean, 0.51);
                else
                    EXPECT_NEAR(test::vertex_value<float>(attribute, v, c), mean, 2e-4);
            }
        }
    }
}

TEST(Attributes, AreMeansByTheFieldsOwnWeights) {
    const test::ParticlesWithArrays noise = test::with_noise(test::splash(3, 8), 1);
    for_each_kind([&](const Settings& settings) {
        test::ParticlesWithArrays particles = noise;
        expect_naive_means(settings, particles, mesh_of(settings, particles));
    });
}

TEST(Attributes, AreMeansForParticleLevelsInDomainsAndOnCappedMeshes) {
    test::Particles leveled = test::splash(5, 8);
    for (std::size_t i = 0; i < leveled.count(); ++i) leveled.levels.push_back(i % 7 == 0 ? 2 : i % 3 == 0 ? 1 : 0);
    test::ParticlesWithArrays particles = test::with_noise(leveled, 2);
    Settings settings = with_all();
    settings.domain = Box{{0.05, 0.02, 0.03}, {0.31, 0.17, 0.33}};
    for (const auto& domain : {std::optional<Box>(), settings.domain}) {
        settings.domain = domain;
        Reconstructor reconstructor(settings, {Backend::cpu, 2});
        Mesh mesh;
        reconstructor.reconstruct(particles.frame(), mesh);
        expect_naive_means(settings, particles, mesh);
        EXPECT_EQ(reconstructor.statistics().vertices_without_particles, 0U);
        for (const int max_level : {1, 2}) {
            reconstructor.emit_capped(max_level, mesh);
            expect_naive_means(settings, particles, mesh);
        }
    }
}

TEST(Attributes, ConstantsArriveExactly) {
    const test::Particles particles = test::splash(3, 8);
    const float constants[] = {0.1F, -3e-39F, FLT_MAX, -1234.567F, 1e30F};
    for_each_kind([&](const Settings& settings) {
        test::ParticlesWithArrays p;
        p.particles = particles;
        p.add_floats("first", 4, [&](std::size_t, std::size_t c) { return constants[c]; });
        p.add_floats("second", 1, [&](std::size_t, std::size_t) { return constants[4]; });
        p.add<std::uint8_t>("byte", ElementType::uint8, 3, [](std::size_t, std::size_t c) { return 10 + 100 * c; });
        p.add<std::int32_t>("id", ElementType::int32, 1, [](std::size_t, std::size_t) { return -17; });
        const Mesh mesh = mesh_of(settings, p);
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            for (std::size_t c = 0; c < 4; ++c)
                ASSERT_EQ(test::vertex_value<float>(mesh.attributes[0], v, c), constants[c]);
            ASSERT_EQ(test::vertex_value<float>(mesh.attributes[1], v), constants[4]);
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_EQ(test::vertex_value<std::uint8_t>(mesh.attributes[2], v, c), 10 + 100 * c);
            ASSERT_EQ(test::vertex_value<std::int32_t>(mesh.attributes[3], v), -17);
        }
    });
}

TEST(Attributes, StayFiniteAndWithinTheRangeOfTheParticles) {
    test::ParticlesWithArrays p;
    p.particles = test::splash(4, 6);
    p.add_floats("vast", 1, [](std::size_t i, std::size_t) { return i % 2 == 0 ? FLT_MAX : -FLT_MAX; });
    p.add_floats("tiny", 1, [](std::size_t i, std::size_t) { return i % 2 == 0 ? FLT_TRUE_MIN : 0.0F; });
    p.add_floats("share", 1, [](std::size_t i, std::size_t) { return i % 100 == 0 ? 0.0F : 1.0F; });
    const Mesh mesh = mesh_of(with_all(), p);
    bool has_middle = false;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const float vast = test::vertex_value<float>(mesh.attributes[0], v);
        ASSERT_TRUE(std::isfinite(vast));
        has_middle = has_middle || std::abs(vast) < 0.5F * FLT_MAX;
        const float tiny = test::vertex_value<float>(mesh.attributes[1], v);
        ASSERT_TRUE(tiny == 0.0F || tiny == FLT_TRUE_MIN);
        const float share = test::vertex_value<float>(mesh.attributes[2], v);
        ASSERT_TRUE(share >= 0.0F && share <= 1.0F);
    }
    EXPECT_TRUE(has_middle) << "sums overflow";
}

TEST(Attributes, DoNotDependOnTheOrderOfParticlesOnThreadsOrOnInstructionSets) {
    for_each_kind([&](const Settings& settings) {
        test::Particles crowded = test::splash(6, 6);
        // Some lie at one place, with different values.
        for (std::size_t i = 0; i < 60; ++i)
            crowded.add(crowded.positions[3 * i], crowded.positions[3 * i + 1], crowded.positions[3 * i + 2]);
        test::ParticlesWithArrays particles = test::with_noise(crowded, 3);
        const Mesh expected = mesh_of(settings, particles);
        for (unsigned seed = 1; seed <= 3; ++seed) {
            test::ParticlesWithArrays other = particles.shuffled(seed);
            EXPECT_TRUE(test::same_attributes(mesh_of(settings, other, 1 + seed), expected)) << "seed " << seed;
        }
        for (const InstructionSet set : usable_instruction_sets()) {
            setenv("MENISCUS_INSTRUCTIONS", std::string(name_of(set)).c_str(), 1);
            EXPECT_TRUE(test::same_attributes(mesh_of(settings, particles), expected)) << name_of(set);
            unsetenv("MENISCUS_INSTRUCTIONS");
        }
    });
}

TEST(Attributes, OfAnAttributeDoNotDependOnTheOthersThatAreAskedFor) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(7, 6), 4);
    const Mesh all = mesh_of(with_all(), particles);
    for (std::size_t a = 0; a < particles.names.size(); ++a) {
        Settings settings = test::default_settings();
        settings.attributes = {particles.names[a]};
        const Mesh one = mesh_of(settings, particles);
        ASSERT_EQ(one.attributes.size(), 1U);
        EXPECT_EQ(one.attributes[0].name, particles.names[a]);
        EXPECT_TRUE(test::same_bytes(one.attributes[0].data, all.attributes[a].data)) << particles.names[a];
    }
    Settings settings = test::default_settings();
    settings.attributes = {particles.names[7], particles.names[2]};
    const Mesh two = mesh_of(settings, particles);
    EXPECT_EQ(two.attributes[0].name, particles.names[7]) << "in the order of the settings";
    EXPECT_TRUE(test::same_bytes(two.attributes[1].data, all.attributes[2].data));
}

TEST(Attributes, LeaveTheSurfaceAsItIs) {
    for_each_kind([&](Settings settings) {
        test::ParticlesWithArrays particles = test::with_noise(test::splash(8, 6), 5);
        const Mesh with = mesh_of(settings, particles);
        settings.all_attributes = false;
        Reconstructor passing_over(settings, {Backend::cpu, 1});
        Mesh without;
        passing_over.reconstruct(particles.frame(), without);
        EXPECT_TRUE(without.attributes.empty());
        EXPECT_EQ(mesh_sha256(with), mesh_sha256(without));
        EXPECT_TRUE(test::same_bytes(with.vertices, without.vertices));
        EXPECT_TRUE(test::same_bytes(with.normals, without.normals));
        EXPECT_TRUE(test::same_bytes(with.triangles, without.triangles));
        // An array that no setting names takes no memory either.
        Reconstructor of_positions(settings, {Backend::cpu, 1});
        of_positions.reconstruct(particles.particles.frame(), without);
        EXPECT_EQ(passing_over.statistics().peak_bytes, of_positions.statistics().peak_bytes);
    });
}

TEST(Attributes, IdsAreThoseOfTheLargestShareAndOfSeveralTheSmallest) {
    test::ParticlesWithArrays p;
    // Alone, and four at one place, which have the same share everywhere.
    p.particles.add(0.0F, 0.0F, 0.0F);
    for (int i = 0; i < 4; ++i) p.particles.add(1.0F, 0.0F, 0.0F);
    const std::int64_t ids[] = {7, 3, -5, 2'000'000'000, 12};
    const auto id = [&](std::size_t i, std::size_t) { return ids[i]; };
    p.add<std::int32_t>("signed", ElementType::int32, 1, id);
    p.add<std::uint32_t>("unsigned", ElementType::uint32, 1, id);
    for_each_kind([&](const Settings& settings) {
        const Mesh mesh = mesh_of(settings, p);
        ASSERT_FALSE(mesh.vertices.empty());
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            const bool is_alone = mesh.world(mesh.vertices[v])[0] < 0.5;
            EXPECT_EQ(test::vertex_value<std::int32_t>(mesh.attributes[0], v), is_alone ? 7 : -5);
            EXPECT_EQ(test::vertex_value<std::uint32_t>(mesh.attributes[1], v), is_alone ? 7U : 3U)
                << "-5 is 4294967291";
        }
    });
}

TEST(Attributes, BytesAreRoundedToTheNearest) {
    test::ParticlesWithArrays p;
    for (int i = 0; i < 4; ++i) p.particles.add(0.0F, 0.0F, 0.0F);
    // Means of 1.25, 1.5 and 1.75, and the ends.
    const int values[4][4] = {{1, 1, 1, 255}, {1, 1, 2, 255}, {1, 2, 2, 255}, {2, 2, 2, 254}};
    p.add<std::uint8_t>("byte", ElementType::uint8, 4, [&](std::size_t i, std::size_t c) { return values[i][c]; });
    const Mesh mesh = mesh_of(with_all(), p);
    ASSERT_FALSE(mesh.vertices.empty());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        EXPECT_EQ(test::vertex_value<std::uint8_t>(mesh.attributes[0], v, 0), 1);
        EXPECT_EQ(test::vertex_value<std::uint8_t>(mesh.attributes[0], v, 2), 2);
        EXPECT_EQ(test::vertex_value<std::uint8_t>(mesh.attributes[0], v, 3), 255);
    }
}

TEST(Attributes, WhereNoParticleHasAShareTheNearestCounts) {
    // Cells far larger than the particles: a vertex lies at least a 64th of a cell from the point inside.
    test::ParticlesWithArrays p;
    const float cell = 300.0F * 0.025F;
    for (int i = 0; i < 5; ++i) p.particles.add(cell * static_cast<float>(3 * i), 0.0F, 0.0F);
    p.add_floats("number", 1, [](std::size_t i, std::size_t) { return static_cast<float>(10 * i) + 0.5F; });
    p.add<std::uint32_t>("id", ElementType::uint32, 1, [](std::size_t i, std::size_t) { return 100 + i; });
    Settings settings = with_all();
    settings.cell_size = 300.0;
    settings.mode = Mode::uniform;
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Mesh mesh;
    reconstructor.reconstruct(p.frame(), mesh);
    ASSERT_EQ(mesh.vertices.size(), 6U * 5U);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const auto i = static_cast<std::uint32_t>(std::lround(mesh.world(mesh.vertices[v])[0] / double{cell} / 3.0));
        EXPECT_EQ(test::vertex_value<float>(mesh.attributes[0], v), static_cast<float>(10 * i) + 0.5F);
        EXPECT_EQ(test::vertex_value<std::uint32_t>(mesh.attributes[1], v), 100 + i);
    }
    EXPECT_EQ(reconstructor.statistics().vertices_without_particles, 0U);
}

/// The errors of a linear field at the vertices on top of a calm block, in parts of its slope times the support.
struct Departure {
    double largest_along = 0.0, usual_along = 0.0;  ///< largest error, and root of the mean square
    double across = 0.0;                            ///< mean error
};
/// jitter: of the spacing, to either side.
Departure departure_on_top(Settings settings, float jitter) {
    settings.attributes = {"place"};
    constexpr int side = 40, depth = 16;
    constexpr float spacing = 0.05F;
    std::mt19937 random(13);
    std::uniform_real_distribution<float> offset(-jitter, jitter);
    test::ParticlesWithArrays p;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < depth; ++y)
            for (int x = 0; x < side; ++x)
                p.particles.add((static_cast<float>(x) + offset(random)) * spacing,
                                (static_cast<float>(y) + offset(random)) * spacing,
                                (static_cast<float>(z) + offset(random)) * spacing);
    p.add_floats("place", 3, [&](std::size_t i, std::size_t c) { return p.particles.positions[3 * i + c]; });
    const Mesh mesh = mesh_of(settings, p);
    const double h = support(settings) * settings.particle_radius;
    const double top = double{spacing} * (depth - 1);
    const double edge = double{spacing} * (side - 1) - 2.0 * h;
    Departure departure;
    std::size_t seen = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const auto place = mesh.world(mesh.vertices[v]);
        if (place[1] < top - 0.5 * h || place[0] < 2.0 * h || place[2] < 2.0 * h || place[0] > edge || place[2] > edge)
            continue;
        ++seen;
        for (const std::size_t axis : {0U, 2U}) {
            const double along = (double{test::vertex_value<float>(mesh.attributes[0], v, axis)} - place[axis]) / h;
            departure.largest_along = std::max(departure.largest_along, std::abs(along));
            departure.usual_along += along * along;
        }
        departure.across += (place[1] - double{test::vertex_value<float>(mesh.attributes[0], v, 1)}) / h;
    }
    EXPECT_GT(seen, 300U);
    departure.usual_along = std::sqrt(departure.usual_along / static_cast<double>(2 * seen));
    departure.across /= static_cast<double>(seen);
    return departure;
}

// The figures are in core/README.md#attributes.
TEST(Attributes, AFieldThatIsLinearAlongTheSurfaceArrivesAndAcrossItThatOfWaterInside) {
    struct Row {
        Field field;
        double largest_jittered;  ///< particles moved by a tenth of the spacing, a fifth of the radius, to either side
        double usual_of_twice_the_jitter;
        double across;
    };
    for (const Row& row : {Row{Field::smooth, 0.02, 0.02, 0.24}, Row{Field::color, 0.07, 0.04, 0.25},
                           Row{Field::density, 0.07, 0.04, 0.205}}) {
        SCOPED_TRACE(name_of(row.field));
        Settings settings = test::default_settings();
        settings.field = row.field;
        settings.mode = Mode::uniform;
        settings.cell_size = 1.0;
        EXPECT_LT(departure_on_top(settings, 0.0F).largest_along, 0.01);
        const Departure jittered = departure_on_top(settings, 0.1F);
        EXPECT_LT(jittered.largest_along, row.largest_jittered);
        EXPECT_NEAR(jittered.across, row.across, 0.01);
        EXPECT_LT(departure_on_top(settings, 0.2F).usual_along, row.usual_of_twice_the_jitter);
    }
}

TEST(Attributes, AWarmFrameAllocatesNothing) {
    for (const std::vector<std::string>& names : {std::vector<std::string>{"a_0"}, {"a_0", "a_2", "a_7"}}) {
        Settings settings = test::default_settings();
        settings.attributes = names;
        Reconstructor reconstructor(settings, {Backend::cpu, 2});
        Mesh meshes[2];
        test::ParticlesWithArrays particles = test::with_noise(test::splash(41), 6);
        for (Mesh& mesh : meshes) reconstructor.reconstruct(particles.frame(), mesh);
        EXPECT_GT(reconstructor.statistics().allocations, 0U);
        for (int frame = 0; frame < 4; ++frame) {
            reconstructor.reconstruct(particles.frame(), meshes[frame % 2]);
            EXPECT_EQ(reconstructor.statistics().allocations, 0U) << "frame " << frame;
        }
    }
}

TEST(Attributes, AreThoseOfTheReconstructorThatFillsTheMesh) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(9, 4), 7);
    Reconstructor all(with_all(), {Backend::cpu, 1});
    Reconstructor none(test::default_settings(), {Backend::cpu, 1});
    Mesh mesh;
    all.reconstruct(particles.frame(), mesh);
    const Mesh expected = mesh;
    EXPECT_EQ(mesh.attributes.size(), particles.names.size());
    none.reconstruct(particles.frame(), mesh);
    EXPECT_TRUE(mesh.attributes.empty());
    all.reconstruct(particles.frame(), mesh);
    EXPECT_TRUE(test::same_attributes(mesh, expected));
    mesh.clear();
    ASSERT_EQ(mesh.attributes.size(), particles.names.size());
    for (const MeshAttribute& attribute : mesh.attributes) EXPECT_TRUE(attribute.data.empty());
}

}  // namespace
}  // namespace meniscus
