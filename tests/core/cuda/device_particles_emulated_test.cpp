// Particles that are on the device already, on the device in software: the mesh of the same frame from the host, and
// the same refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "engine/cuda/device_memory.hpp"
#include "lattice/coordinates.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

/// A caller's particles in device memory, and the stream on which they come there.
class OnDevice {
public:
    explicit OnDevice(const test::Particles& particles)
        : particles_(particles),
          memory_(0, stream_.get(), std::make_shared<MemoryAccount>()),
          bytes_of_positions_(particles.positions.size() * sizeof(float)) {
        memory_.assign(bytes_of_positions_ + particles.levels.size() + 1);
        stream_.synchronize();
        // On their way: code that does not wait for the stream finds zeros.
        copy(particles_.positions.data(), bytes_of_positions_, memory_.get());
        copy(particles_.levels.data(), particles_.levels.size(), memory_.get() + bytes_of_positions_);
    }

    ParticleFrame frame() const {
        ParticleFrame frame;
        frame.positions = {reinterpret_cast<const float*>(memory_.get()), particles_.positions.size()};
        const auto* const levels = reinterpret_cast<const std::uint8_t*>(memory_.get() + bytes_of_positions_);
        if (!particles_.levels.empty()) frame.levels = {levels, particles_.levels.size()};
        return frame;
    }
    void* stream() const { return stream_.get(); }

private:
    void copy(const void* from, std::size_t bytes, void* to) {
        if (bytes != 0) cuda::check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream_.get()), "copy");
    }

    test::Particles particles_;
    cuda::Stream stream_;
    cuda::DeviceMemory memory_;
    std::size_t bytes_of_positions_;
};

class CheckingDevice {
public:
    explicit CheckingDevice(const Settings& settings)
        : settings_(settings),
          account_(std::make_shared<MemoryAccount>()),
          backend_(cuda::make_reconstruction(settings, BackendOptions{}, account_, account_)) {}

    ParticlesByLevel validate(const OnDevice& particles) {
        return backend_->validate_on_device(particles.frame(), particles.stream(), settings_);
    }
    /// The text with which a frame is refused; empty if it is not.
    std::string refusal(const ParticleFrame& frame, void* stream) {
        try {
            backend_->validate_on_device(frame, stream, settings_);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    }
    std::string refusal(const OnDevice& particles) { return refusal(particles.frame(), particles.stream()); }

    void expect_the_hosts_mesh(const test::Particles& particles) {
        const Mesh expected = test::reconstruct(settings_, particles.frame());
        const OnDevice on_device(particles);
        validate(on_device);
        mesh_.cell_size = expected.cell_size;
        mesh_.offset_bits = expected.offset_bits;
        backend_->reconstruct({on_device.frame(), true}, mesh_, statistics_).finish();
        EXPECT_EQ(mesh_sha256(mesh_), mesh_sha256(expected));
        EXPECT_TRUE(test::same_bytes(mesh_.normals, expected.normals));
        EXPECT_TRUE(test::same_bytes(mesh_.triangles, expected.triangles));
    }
    std::string emitted_again() {
        backend_->emit_capped(3, mesh_);
        return mesh_sha256(mesh_);
    }
    const Mesh& mesh() const { return mesh_; }

private:
    Settings settings_;
    std::shared_ptr<MemoryAccount> account_;
    std::unique_ptr<BackendReconstruction> backend_;
    Mesh mesh_;
    Statistics statistics_;
};

test::Particles leveled(test::Particles particles) {
    for (std::size_t i = 0; i < particles.count(); ++i) particles.levels.push_back(i % 7 == 0 ? 2 : i % 3 == 0 ? 1 : 0);
    return particles;
}

TEST(DeviceParticlesEmulated, HaveTheMeshOfTheSameFrameFromTheHost) {
    CheckingDevice device(test::default_settings());
    // Grown, run launch by launch, captured, replayed; with frames of another kind between.
    for (const int side : {3, 5, 5, 5, 5, 2}) {
        SCOPED_TRACE(side);
        device.expect_the_hosts_mesh(test::splash(3, side));
    }
    for (int round = 0; round < 3; ++round) device.expect_the_hosts_mesh(leveled(test::splash(4, 4)));
    device.expect_the_hosts_mesh(test::splash(5, 4));
    device.expect_the_hosts_mesh({});
}

TEST(DeviceParticlesEmulated, AreCountedByLevel) {
    CheckingDevice device(test::default_settings());
    const test::Particles uniform = test::splash(4, 12);
    EXPECT_EQ(device.validate(OnDevice(uniform)), (ParticlesByLevel{uniform.count()}));
    const test::Particles mixed = leveled(uniform);
    ParticlesByLevel expected{};
    for (const std::uint8_t level : mixed.levels) ++expected[level];
    EXPECT_EQ(device.validate(OnDevice(mixed)), expected);
}

TEST(DeviceParticlesEmulated, AreRefusedWithTheWordsOfTheHost) {
    const Settings settings = test::default_settings();
    const auto expect_the_hosts_words = [&](const test::Particles& particles, const std::string& words) {
        std::string expected;
        try {
            validate(particles.frame(), settings);
        } catch (const InvalidInput& error) {
            expected = error.what();
        }
        EXPECT_NE(expected.find(words), std::string::npos) << expected;
        EXPECT_EQ(CheckingDevice(settings).refusal(OnDevice(particles)), expected);
    };
    const test::Particles good = test::splash(5, 12);
    ASSERT_GT(good.count(), 700U);
    const std::size_t last = good.positions.size() - 1;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    test::Particles bad = good;
    bad.positions[last] = nan;
    expect_the_hosts_words(bad, "has z = nan");
    bad.positions[901] = -inf;
    bad.positions[2000] = 1e30F;
    expect_the_hosts_words(bad, "particle 300 has y = -inf");
    bad.positions[0] = 1e30F;
    expect_the_hosts_words(bad, "particle 0 has x = 1");
    // The last number that can be addressed, and the first that cannot.
    bad = good;
    const double limit = static_cast<double>(max_cell) * world_cell_size(settings);
    auto last_good = static_cast<float>(limit);
    if (static_cast<double>(last_good) > limit) last_good = std::nextafter(last_good, 0.0F);
    bad.positions[4] = -last_good;
    EXPECT_NO_THROW(validate(bad.frame(), settings));
    EXPECT_EQ(CheckingDevice(settings).refusal(OnDevice(bad)), "");
    bad.positions[4] = -std::nextafter(last_good, inf);
    expect_the_hosts_words(bad, "particle 1 has y = -");

    bad = leveled(good);
    bad.levels[77] = 5;
    bad.levels[500] = 255;
    bad.levels[501] = 255;
    bad.positions[1] = nan;
    expect_the_hosts_words(bad, "particle 500 has level 255");
    bad.levels[500] = bad.levels[501] = 0;
    expect_the_hosts_words(bad, "particle 77 has level 5");
}

TEST(DeviceParticlesEmulated, LevelsTooCoarseForTheCellsAreRefusedAsOnTheHost) {
    Settings settings = test::default_settings();
    settings.cell_size = 6.0 / 60.0;
    test::Particles particles = test::splash(5, 2);
    particles.levels.assign(particles.count(), 3);
    EXPECT_THROW(validate(particles.frame(), settings), InvalidInput);
    EXPECT_NE(
        CheckingDevice(settings).refusal(OnDevice(particles)).find("the support of particle level 3 spans 480 cells"),
        std::string::npos);
}

TEST(DeviceParticlesEmulated, WhatLiesOnTheHostIsRefused) {
    CheckingDevice device(test::default_settings());
    const test::Particles particles = leveled(test::splash(6, 3));
    cuda::Stream stream;
    EXPECT_NE(device.refusal(particles.frame(), stream.get()).find("the frame's positions lie in memory of the host"),
              std::string::npos);
    const OnDevice on_device(particles);
    ParticleFrame frame = on_device.frame();
    frame.levels = particles.levels;
    EXPECT_NE(device.refusal(frame, stream.get()).find("the frame's levels lie in memory of the host"),
              std::string::npos);
}

TEST(DeviceParticlesEmulated, AFrameThatIsRefusedLeavesTheSurfaceBefore) {
    CheckingDevice device(test::default_settings());
    device.expect_the_hosts_mesh(test::splash(7, 5));
    const std::string expected = mesh_sha256(device.mesh());
    test::Particles bad = test::splash(8, 14);
    bad.positions[bad.positions.size() / 2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(device.refusal(OnDevice(bad)), "");
    EXPECT_EQ(device.emitted_again(), expected);
    device.expect_the_hosts_mesh(test::splash(9, 4));
}

}  // namespace
}  // namespace meniscus
