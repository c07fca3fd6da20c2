// Particles that carry more than a position, on the device in software: the CPU's order, and its mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "pipeline/cuda_frame_run.hpp"
#include "steps/cpu_steps.hpp"
#include "support/particles.hpp"
#include "support/payload.hpp"

namespace meniscus {
namespace {

class Device {
public:
    /// The payloads of the sorted particles, all levels in one.
    std::vector<std::vector<std::byte>> sorted_payloads(test::ParticlesWithPayload& particles) {
        run_.run(particles.frame());
        std::vector<std::vector<std::byte>> payloads;
        for (std::size_t i = 0; i < particles.particles.count(); ++i)
            payloads.push_back(particles.payload_of(run_.state().sources[i]));
        return payloads;
    }
    /// Indices in the frame of the sorted particles, all levels in one.
    std::vector<std::uint32_t> sources(const ParticleFrame& frame) {
        run_.run(frame);
        return {run_.state().sources, run_.state().sources + frame.count()};
    }
    void run(const ParticleFrame& frame) { run_.run(frame); }
    std::uint64_t bytes() const { return device_account_->bytes(); }

private:
    std::shared_ptr<MemoryAccount> account_ = std::make_shared<MemoryAccount>();
    std::shared_ptr<MemoryAccount> device_account_ = std::make_shared<MemoryAccount>();
    cuda::MeshSets sets_{0, account_, device_account_};
    cuda::UploadAreas areas_{0, device_account_};
    cuda::FrameRun run_{
        LatticeSettings(test::default_settings()), BackendOptions{}, sets_, areas_, account_, device_account_};
};

/// The same on the CPU.
std::vector<std::uint32_t> sources_on_cpu(const ParticleFrame& frame) {
    const LatticeSettings settings(test::default_settings());
    const auto account = std::make_shared<MemoryAccount>();
    cpu::Workers workers(1);
    cpu::State state(account, workers, settings);
    cpu::ParticleSets sets(account, workers, settings);
    cpu::NeighborSearch near(account, workers.count(), sets);
    cpu::register_particles(state, sets, near, frame);
    std::vector<std::uint32_t> sources;
    for (const cpu::ParticleSet& set : sets.of_level)
        sources.insert(sources.end(), set.sources.begin(), set.sources.end());
    return sources;
}

TEST(PayloadEmulated, ComesInTheSameOrderWhateverTheOrderOfTheFrame) {
    for (const bool levels : {false, true}) {
        Device device;
        test::ParticlesWithPayload particles = test::crowded_places(levels);
        const auto expected = device.sorted_payloads(particles);
        // The same device: with more room, then captured as a graph, then replayed, with frames without payload
        // between.
        for (unsigned seed = 1; seed <= 6; ++seed) {
            test::ParticlesWithPayload other = particles.shuffled(seed);
            EXPECT_EQ(device.sorted_payloads(other), expected) << "seed " << seed;
            if (seed % 3 == 0) device.run(particles.particles.frame());
        }
    }
}

TEST(PayloadEmulated, HasTheCpusOrder) {
    std::mt19937 random(7);
    for (const bool levels : {false, true})
        for (const bool quantized : {false, true}) {
            SCOPED_TRACE(testing::Message() << "levels " << levels << ", quantized " << quantized);
            const test::Particles particles = test::crowded_places(levels).particles;
            std::vector<std::uint16_t> coordinates;
            for (const float x : particles.positions)
                coordinates.push_back(static_cast<std::uint16_t>(std::lround((x + 2.0F) * 8192.0F)));
            ParticleFrame frame = particles.frame();
            if (quantized) {
                frame.positions = {};
                frame.quantized = coordinates;
                frame.quantization_box = {{-2.0, -2.0, -2.0}, {6.0, 6.0, 6.0}};
            }
            // As many arrays as there can be, of elements of 1 to 16 bytes that are often the same.
            std::vector<std::vector<std::byte>> bytes;
            std::vector<ParticleArray> arrays;
            for (std::size_t size = 1; size <= max_particle_arrays; ++size) {
                auto& data = bytes.emplace_back(size * frame.count());
                for (std::size_t i = 0; i < data.size(); i += size)
                    data[i + size - 1] = static_cast<std::byte>(random() % 8 == 0 ? 255 : 0);
                arrays.push_back({"array", data, ElementType::uint8, size});
            }
            frame.arrays = arrays;
            EXPECT_EQ(Device().sources(frame), sources_on_cpu(frame));
        }
}

TEST(PayloadEmulated, TakesRoomForItsOwnBytesHoweverManyParticlesEarlierFramesHad) {
    Device device;
    const test::Particles many = test::splash(3, 12);
    device.run(many.frame());
    test::Particles one;
    one.add(0.0F, 0.0F, 0.0F);
    const std::vector<std::byte> element(std::size_t{1} << 20);
    const ParticleArray array{"large", element, ElementType::uint8, element.size()};
    ParticleFrame frame = one.frame();
    frame.arrays = {&array, 1};
    const std::uint64_t before = device.bytes();
    device.run(frame);
    EXPECT_LT(device.bytes() - before, 2 * element.size());
}

TEST(PayloadEmulated, OfNoParticlesTakesNoRoomHoweverLargeItsElements) {
    Device device;
    test::ParticlesWithPayload particles = test::crowded_places(false);
    const auto expected = device.sorted_payloads(particles);
    Device other;
    // Large enough for their product with a capacity to wrap around.
    const ParticleArray array{"none", {}, ElementType::uint8, std::size_t{1} << 56};
    ParticleFrame empty;
    empty.arrays = {&array, 1};
    other.run(empty);
    EXPECT_EQ(other.sorted_payloads(particles), expected);
}

TEST(PayloadEmulated, LeavesTheSurfaceAsItIs) {
    test::ParticlesWithPayload particles = test::crowded_places(true);
    const Mesh expected = test::reconstruct(test::default_settings(), particles.particles.frame());
    const auto account = std::make_shared<MemoryAccount>();
    const auto backend = cuda::make_reconstruction(test::default_settings(), BackendOptions{}, account, account);
    Statistics statistics;
    for (int round = 0; round < 4; ++round) {
        Mesh mesh;
        mesh.cell_size = expected.cell_size;
        mesh.offset_bits = expected.offset_bits;
        backend->reconstruct(particles.frame(), mesh, statistics).finish();
        EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(expected));
    }
}

}  // namespace
}  // namespace meniscus
