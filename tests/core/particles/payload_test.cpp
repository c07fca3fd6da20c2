// Particles that carry more than a position are sorted with an index to it, the same in whatever order they come.
#include "particles/payload.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "meniscus/error.hpp"
#include "meniscus/meniscus.hpp"
#include "steps/cpu_steps.hpp"
#include "support/particles.hpp"
#include "support/payload.hpp"

namespace meniscus {
namespace {

/// The sorted particles of a frame after the CPU's first step.
class Registered {
public:
    Registered(const ParticleFrame& frame, unsigned threads) : workers_(threads) {
        cpu::register_particles(state_, sets_, near_, frame);
    }
    const cpu::ParticleSet& set(std::size_t level) const { return sets_[level]; }

private:
    LatticeSettings settings_{test::default_settings()};
    std::shared_ptr<MemoryAccount> account_ = std::make_shared<MemoryAccount>();
    cpu::Workers workers_;
    cpu::State state_{account_, workers_, settings_};
    cpu::ParticleSets sets_{account_, workers_, settings_};
    cpu::NeighborSearch near_{account_, workers_.count(), sets_};
};

std::vector<std::vector<std::byte>> sorted_payloads(const test::ParticlesWithPayload& particles,
                                                    const Registered& registered) {
    std::vector<std::vector<std::byte>> payloads;
    for (std::size_t level = 0; level < particle_level_count; ++level)
        for (const std::uint32_t source : registered.set(level).sources)
            payloads.push_back(particles.payload_of(source));
    return payloads;
}

TEST(Payload, FollowsItsParticleThroughTheSort) {
    for (const bool levels : {false, true}) {
        test::ParticlesWithPayload particles = test::crowded_places(levels);
        const ParticleFrame frame = particles.frame();
        const Registered registered(frame, 2);
        const Registered alone(particles.particles.frame(), 1);
        const double unit = world_cell_size(test::default_settings()) / units_per_cell;
        std::vector<bool> seen(frame.count());
        for (std::size_t level = 0; level < particle_level_count; ++level) {
            const cpu::ParticleSet& set = registered.set(level);
            ASSERT_EQ(set.sources.size(), set.count());
            EXPECT_TRUE(alone.set(level).sources.empty());
            ASSERT_EQ(alone.set(level).count(), set.count());
            for (std::size_t i = 0; i < set.count(); ++i) {
                const std::uint32_t source = set.sources[i];
                ASSERT_FALSE(seen[source]);
                seen[source] = true;
                EXPECT_EQ(frame.levels.empty() ? 0U : frame.levels[source], level);
                // The key names the place of the particle that it came from.
                const Units3 corner = cell_corner(set.keys[i].cell, set.cell_units);
                const auto in_cell = static_cast<std::int64_t>(set.keys[i].place & ((1U << place_axis_bits) - 1));
                EXPECT_EQ(corner.x + in_cell, std::llrint(double{frame.positions[3 * std::size_t{source}]} / unit));
                EXPECT_TRUE(!(alone.set(level).keys[i] < set.keys[i]) && !(set.keys[i] < alone.set(level).keys[i]))
                    << "an index changes the order of keys";
            }
        }
        EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool s) { return s; }));
    }
}

TEST(Payload, ComesInTheSameOrderWhateverTheOrderOfTheFrame) {
    for (const bool levels : {false, true}) {
        test::ParticlesWithPayload particles = test::crowded_places(levels);
        const auto expected = sorted_payloads(particles, Registered(particles.frame(), 1));
        ASSERT_EQ(expected.size(), particles.particles.count());
        for (unsigned seed = 1; seed <= 5; ++seed) {
            test::ParticlesWithPayload other = particles.shuffled(seed);
            EXPECT_EQ(sorted_payloads(other, Registered(other.frame(), 1 + seed % 3)), expected) << "seed " << seed;
        }
    }
}

TEST(Payload, LeavesTheSurfaceAsItIs) {
    test::ParticlesWithPayload particles = test::crowded_places(true);
    EXPECT_EQ(mesh_sha256(test::reconstruct(test::default_settings(), particles.frame())),
              mesh_sha256(test::reconstruct(test::default_settings(), particles.particles.frame())));
}

TEST(Payload, HeapSortGivesTheOrderOfTheComparison) {
    std::mt19937 random(9);
    std::vector<std::uint8_t> values(500);
    for (std::uint8_t& v : values) v = static_cast<std::uint8_t>(random() % 7);
    PayloadView payload;
    payload.arrays = 1;
    payload.data[0] = reinterpret_cast<const std::byte*>(values.data());
    payload.element_bytes[0] = 1;
    for (const std::uint32_t n : {0U, 1U, 2U, 3U, 17U, 500U}) {
        std::vector<std::uint32_t> particles(n);
        std::iota(particles.begin(), particles.end(), 0U);
        std::shuffle(particles.begin(), particles.end(), random);
        std::vector<std::uint32_t> expected = particles;
        std::sort(expected.begin(), expected.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return payload.before(a, b); });
        sort_by_payload(payload, particles.data(), n);
        EXPECT_EQ(particles, expected);
    }
}

TEST(Payload, IsRefusedByNameWhereItDoesNotFitTheParticles) {
    test::ParticlesWithPayload particles = test::crowded_places(false);
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1});
    Mesh mesh;
    const auto expect_refusal = [&](const ParticleFrame& frame, const char* message) {
        try {
            reconstructor.reconstruct(frame, mesh);
            FAIL() << "was accepted";
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    };
    ParticleFrame frame = particles.frame();
    particles.arrays[1].data = particles.arrays[1].data.first(particles.arrays[1].data.size() - 1);
    expect_refusal(frame, "array 'phase' has");
    particles.arrays[1].components = 0;
    expect_refusal(frame, "array 'phase' has 0 components");
    const std::vector<ParticleArray> many(max_particle_arrays + 1, particles.arrays[0]);
    frame.arrays = many;
    expect_refusal(frame, "17 arrays, at most 16");
    reconstructor.reconstruct(particles.particles.frame(), mesh);
    EXPECT_FALSE(mesh.triangles.empty());
}

}  // namespace
}  // namespace meniscus
