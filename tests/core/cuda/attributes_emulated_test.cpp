// Attributes by the CUDA backend's kernels, on the device in software: the CPU's bits.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "engine/cuda/device_memory.hpp"
#include "meniscus/meniscus.hpp"
#include "particles/attribute_choice.hpp"
#include "pipeline/backend.hpp"
#include "support/attributes.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

Settings with_all(Settings settings = test::default_settings()) {
    settings.all_attributes = true;
    return settings;
}

/// The part of a Reconstructor around the backend.
class AttributesDevice {
public:
    explicit AttributesDevice(const Settings& settings)
        : settings_(settings),
          choice_(settings),
          cpu_(settings, {Backend::cpu, 1}),
          backend_(cuda::make_reconstruction(settings, BackendOptions{}, account_, device_account_)) {}

    PlacedFrame placed(const ParticleFrame& frame, bool on_device = false) {
        chosen_ = choice_.of(frame);
        PlacedFrame placed(frame, on_device);
        placed.frame.arrays = chosen_;
        if (on_device)
            placed.attributes = backend_->numbers_on_device(placed.frame);
        else
            placed.attributes = numbers_in_host_memory(chosen_);
        choice_.keep(chosen_);
        return placed;
    }

    void expect_the_cpus_values(const ParticleFrame& frame) {
        Mesh expected;
        cpu_.reconstruct(frame, expected);
        mesh_.clear();
        const PlacedFrame particles = placed(frame);
        choice_.shape(mesh_, account_);
        backend_->reconstruct(particles, mesh_, statistics_).finish();
        EXPECT_TRUE(test::same_bytes(mesh_.vertices, expected.vertices));
        EXPECT_TRUE(test::same_bytes(mesh_.normals, expected.normals));
        EXPECT_TRUE(test::same_attributes(mesh_, expected));
        EXPECT_EQ(statistics_.vertices_without_particles, cpu_.statistics().vertices_without_particles);
        cpu_.emit_capped(2, expected);
        backend_->emit_capped(2, mesh_);
        EXPECT_TRUE(test::same_attributes(mesh_, expected)) << "levels up to 2";
    }

    BackendReconstruction& backend() { return *backend_; }
    const MemoryAccount& memory() const { return *device_account_; }
    const AttributeChoice& choice() const { return choice_; }

private:
    Settings settings_;
    AttributeChoice choice_;
    Reconstructor cpu_;
    std::vector<ParticleArray> chosen_;
    std::shared_ptr<MemoryAccount> account_ = std::make_shared<MemoryAccount>();
    std::shared_ptr<MemoryAccount> device_account_ = std::make_shared<MemoryAccount>();
    std::unique_ptr<BackendReconstruction> backend_;
    Mesh mesh_;
    Statistics statistics_;
};

TEST(AttributesEmulated, AreTheCpusForAllFieldsAndModes) {
    test::Particles crowded = test::splash(3, 4);
    for (std::size_t i = 0; i < 30; ++i)
        crowded.add(crowded.positions[3 * i], crowded.positions[3 * i + 1], crowded.positions[3 * i + 2]);
    test::ParticlesWithArrays particles = test::with_noise(crowded, 1);
    for (const Field field : choices<Field>)
        for (const bool adaptive : {true, false}) {
            SCOPED_TRACE(testing::Message() << name_of(field) << ", adaptive: " << adaptive);
            Settings settings = with_all();
            settings.field = field;
            settings.mode = adaptive ? Mode::adaptive : Mode::uniform;
            settings.normals = adaptive;
            if (!adaptive) settings.edge_points = Bisection{3};
            AttributesDevice(settings).expect_the_cpus_values(particles.frame());
        }
}

TEST(AttributesEmulated, AreTheCpusForParticleLevelsDomainsAndSpray) {
    test::Particles leveled = test::splash(5, 4);
    for (std::size_t i = 0; i < leveled.count(); ++i) leveled.levels.push_back(i % 7 == 0 ? 2 : i % 3 == 0 ? 1 : 0);
    test::ParticlesWithArrays particles = test::with_noise(leveled, 2);
    Settings settings = with_all();
    for (const Spray spray : choices<Spray>) {
        settings.spray = spray;
        AttributesDevice(settings).expect_the_cpus_values(particles.frame());
    }
    settings.domain = Box{{0.03, 0.02, 0.03}, {0.15, 0.1, 0.17}};
    AttributesDevice(settings).expect_the_cpus_values(particles.frame());
}

TEST(AttributesEmulated, AreTheCpusWhereNoParticleHasAShare) {
    test::Particles apart;
    for (int i = 0; i < 9; ++i) apart.add(0.4F * static_cast<float>(i * i), 0.3F * static_cast<float>(i), 0.0F);
    test::ParticlesWithArrays particles = test::with_noise(apart, 3);
    for (const double cell_size : {20.0, 90.0, 300.0}) {
        Settings settings = with_all();
        settings.cell_size = cell_size;
        AttributesDevice(settings).expect_the_cpus_values(particles.frame());
    }
}

TEST(AttributesEmulated, AreTheCpusInFramesThatGrowShrinkAndAreReplayed) {
    AttributesDevice device(with_all());
    device.expect_the_cpus_values(ParticleFrame{});
    for (const int side : {3, 3, 3, 6, 2, 6}) {
        test::ParticlesWithArrays particles = test::with_noise(test::splash(6, side), static_cast<unsigned>(side));
        device.expect_the_cpus_values(particles.frame());
    }
    device.expect_the_cpus_values(ParticleFrame{});
    test::ParticlesWithArrays particles = test::with_noise(test::splash(6, 6), 9);
    device.expect_the_cpus_values(particles.frame());
    device.expect_the_cpus_values(particles.frame());
    const std::uint64_t allocations = device.memory().allocations();
    device.expect_the_cpus_values(particles.frame());
    EXPECT_EQ(device.memory().allocations(), allocations);
}

TEST(AttributesEmulated, OnesThatAreNotNamedAreNeitherUploadedNorGivenRoom) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(6, 4), 4);
    AttributesDevice device(test::default_settings()), bare(test::default_settings());
    device.expect_the_cpus_values(particles.frame());
    bare.expect_the_cpus_values(particles.particles.frame());
    EXPECT_EQ(device.memory().peak_bytes(), bare.memory().peak_bytes());
}

/// A caller's particles and their arrays in device memory.
class ArraysOnDevice {
public:
    explicit ArraysOnDevice(test::ParticlesWithArrays particles)
        : particles_(std::move(particles)), memory_(0, stream_.get(), std::make_shared<MemoryAccount>()) {
        const ParticleFrame host = particles_.frame();
        std::size_t bytes = host.positions.size_bytes() + 16;
        for (const ParticleArray& array : host.arrays) bytes += array.data.size() + 16;
        memory_.assign(bytes);
        stream_.synchronize();
        std::byte* next = memory_.get();
        const auto copy = [&](std::span<const std::byte> from) {
            cuda::check(cudaMemcpyAsync(next, from.data(), from.size(), cudaMemcpyHostToDevice, stream_.get()), "copy");
            const std::span<const std::byte> there{next, from.size()};
            next += (from.size() + 15) / 16 * 16;
            return there;
        };
        const auto positions = copy(std::as_bytes(host.positions));
        frame_.positions = {reinterpret_cast<const float*>(positions.data()), host.positions.size()};
        arrays_.assign(host.arrays.begin(), host.arrays.end());
        for (ParticleArray& array : arrays_) array.data = copy(array.data);
        frame_.arrays = arrays_;
    }
    const ParticleFrame& frame() const { return frame_; }
    void* stream() const { return stream_.get(); }

private:
    test::ParticlesWithArrays particles_;
    cuda::Stream stream_;
    cuda::DeviceMemory memory_;
    std::vector<ParticleArray> arrays_;
    ParticleFrame frame_;
};

TEST(AttributesEmulated, OfParticlesOnTheDeviceAreThoseOfTheSameFrameFromTheHost) {
    const Settings settings = with_all();
    test::ParticlesWithArrays particles = test::with_noise(test::splash(3, 4), 5);
    const Mesh expected = test::reconstruct(settings, particles.frame());
    AttributesDevice device(settings);
    for (int round = 0; round < 3; ++round) {
        const ArraysOnDevice there(particles);
        Statistics statistics;
        device.backend().validate_on_device(there.frame(), there.stream(), settings);
        const PlacedFrame placed = device.placed(there.frame(), true);
        DeviceMesh mesh = device.backend().reconstruct_on_device(placed, statistics);
        device.choice().describe(mesh.attributes);
        ASSERT_EQ(mesh.attributes.size(), expected.attributes.size());
        ASSERT_EQ(mesh.vertex_count, expected.vertices.size());
        for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
            EXPECT_EQ(mesh.attributes[a].name, expected.attributes[a].name);
            EXPECT_EQ(mesh.attributes[a].type, expected.attributes[a].type);
            EXPECT_EQ(mesh.attributes[a].components, expected.attributes[a].components);
            // The device's memory is the host's.
            EXPECT_EQ(std::memcmp(mesh.attributes[a].data, expected.attributes[a].data.data(),
                                  expected.attributes[a].data.size()),
                      0);
        }
    }
}

TEST(AttributesEmulated, ValuesOnTheDeviceThatAreNotFiniteAreRefusedWithTheWordsOfTheHost) {
    const Settings settings = with_all();
    const test::ParticlesWithArrays good = test::with_noise(test::splash(3, 8), 6);
    for (const std::size_t array : {0U, 1U, 2U}) {
        test::ParticlesWithArrays bad = good;
        const float inf = -std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
        for (const auto& [at, value] : {std::pair{std::size_t{201}, inf}, std::pair{std::size_t{202}, nan}})
            std::memcpy(bad.bytes[array].data() + 4 * at, &value, sizeof value);
        std::string expected;
        try {
            validate(bad.frame(), settings);
        } catch (const InvalidInput& error) {
            expected = error.what();
        }
        EXPECT_NE(expected.find("'a_" + std::to_string(array) + "'"), std::string::npos) << expected;
        AttributesDevice device(settings);
        const ArraysOnDevice there(bad);
        device.backend().validate_on_device(there.frame(), there.stream(), settings);
        try {
            device.placed(there.frame(), true);
            ADD_FAILURE() << "was accepted";
        } catch (const InvalidInput& error) {
            EXPECT_EQ(error.what(), expected);
        }
    }
    // The values themselves, in memory of the host.
    test::ParticlesWithArrays particles = good;
    const ArraysOnDevice there(particles);
    ParticleFrame frame = there.frame();
    const ParticleFrame host = particles.frame();
    frame.arrays = host.arrays;
    AttributesDevice device(settings);
    device.backend().validate_on_device(there.frame(), there.stream(), settings);
    try {
        device.placed(frame, true);
        ADD_FAILURE() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("values of 'a_0' lie in memory of the host"), std::string::npos);
    }
}

}  // namespace
}  // namespace meniscus
