// The particles that are chosen for a part are those within its box, whatever their order and their encoding.
#include "parts/particles_near.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "particles/positions.hpp"
#include "parts/part_particles.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// Particles in a cube of edge 1, or in rows along x; each has its number as an attribute.
struct Numbered {
    Numbered(std::size_t count, unsigned seed, bool in_rows, bool is_quantized) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> place(0.0F, 1.0F);
        for (std::size_t i = 0; i < 3 * count; ++i) positions.push_back(place(random));
        if (in_rows)
            for (std::size_t i = 0; i < count; ++i)
                positions[3 * i] = static_cast<float>(i) / static_cast<float>(count);
        for (const float x : positions) quantized.push_back(static_cast<std::uint16_t>(x * 65535.0F));
        for (std::size_t i = 0; i < count; ++i) levels.push_back(static_cast<std::uint8_t>(i % 3));
        numbers.resize(count);
        std::iota(numbers.begin(), numbers.end(), 0.0F);
        arrays.push_back({"number", std::as_bytes(std::span(numbers)), ElementType::float32, 1});
        if (is_quantized) {
            frame.quantized = quantized;
            frame.quantization_box = {{-1.0, 2.0, 0.0}, {1.0, 2.5, 0.1}};
        } else {
            frame.positions = positions;
        }
        frame.levels = levels;
        frame.arrays = arrays;
    }
    bool is_within(std::size_t particle, const Box& box) const {
        bool is_within = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& [min, max] = frame.quantization_box;
            const double x = frame.is_quantized()
                                 ? min[axis] + quantized[3 * particle + axis] * (max[axis] - min[axis]) / 65535.0
                                 : double{positions[3 * particle + axis]};
            is_within = is_within && x >= box.min[axis] && x <= box.max[axis];
        }
        return is_within;
    }

    std::vector<float> positions, numbers;
    std::vector<std::uint16_t> quantized;
    std::vector<std::uint8_t> levels;
    std::vector<ParticleArray> arrays;
    ParticleFrame frame;
};

/// Corners are at particles as a rule: those on the border are within.
Box random_box(const Numbered& particles, std::mt19937& random) {
    const Box& decoded = particles.frame.quantization_box;
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double ends[2];
        for (double& end : ends) {
            const std::size_t i = random() % particles.positions.size() / 3 * 3 + axis;
            end = particles.frame.is_quantized()
                      ? decoded.min[axis] + particles.quantized[i] * (decoded.max[axis] - decoded.min[axis]) / 65535.0
                      : double{particles.positions[i]};
        }
        box.min[axis] = random() % 4 == 0 ? -1e300 : std::min(ends[0], ends[1]);
        box.max[axis] = random() % 4 == 0 ? 1e300 : std::max(ends[0], ends[1]);
    }
    return box;
}

TEST(ParticlesNear, AreThoseWithinTheBox) {
    const Settings settings = test::default_settings();
    const double units = units_per_length(settings);
    std::mt19937 random(8);
    ParticlesNear near;
    std::vector<std::byte> message;
    std::size_t chosen = 0;
    for (const std::size_t count : {1U, 7U, 255U, 256U, 257U, 2000U})
        for (const bool is_quantized : {false, true})
            for (const bool in_rows : {false, true}) {
                const Numbered particles(count, static_cast<unsigned>(count), in_rows, is_quantized);
                near.begin(particles.frame, settings);
                for (int i = 0; i < 50; ++i) {
                    const Box box = random_box(particles, random);
                    message = near.within(box, std::move(message));
                    PartParticles part;
                    part.begin(FrameForm(particles.frame));
                    part.add(message);
                    const ParticleFrame& got = part.frame();
                    const auto* const numbers = reinterpret_cast<const float*>(got.arrays[0].data.data());
                    std::size_t at = 0;
                    for (std::size_t p = 0; p < count; ++p) {
                        if (!particles.is_within(p, box)) continue;
                        ASSERT_LT(at, got.count());
                        ASSERT_EQ(numbers[at], static_cast<float>(p));
                        ASSERT_EQ(got.levels[at], particles.levels[p]);
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            if (is_quantized)
                                ASSERT_EQ(got.quantized[3 * at + axis], particles.quantized[3 * p + axis]);
                            else
                                ASSERT_EQ(snap(got.positions[3 * at + axis], units),
                                          snap(particles.positions[3 * p + axis], units));
                        }
                        ++at;
                    }
                    ASSERT_EQ(at, got.count());
                    chosen += at;
                }
            }
    EXPECT_GT(chosen, 10'000U);
}

TEST(ParticlesNear, AreFoundBeyondFloat32) {
    const std::vector<std::uint16_t> quantized{0, 0, 0, 40000, 40000, 40000, 65535, 65535, 65535};
    ParticleFrame frame;
    frame.quantized = quantized;
    frame.quantization_box = {{-1e45, -1e45, -1e45}, {1e45, 1e45, 1e45}};
    ParticlesNear near;
    near.begin(frame, test::default_settings());
    PartParticles part;
    part.begin(FrameForm(frame));
    part.add(near.within({{1e44, 1e44, 1e44}, {9e44, 9e44, 9e44}}, {}));
    EXPECT_TRUE(std::ranges::equal(part.frame().quantized, std::span(quantized).subspan(3, 3)));
}

TEST(ParticlesNear, AreNoneOfNone) {
    ParticlesNear near;
    near.begin({}, test::default_settings());
    EXPECT_TRUE(near.within({{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}, {}).empty());
}

}  // namespace
}  // namespace meniscus
