// Particle frames with arrays for tests, and the meshes that must come of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/canonical_order.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {

inline Settings settings_with(std::vector<std::string> attributes) {
    Settings with = settings();
    with.attributes = std::move(attributes);
    return with;
}

/// Velocities, ids and colours of particles. `time` changes the velocities alone.
struct ParticlesWithArrays {
    explicit ParticlesWithArrays(Particles p, double time = 0.0) : particles(std::move(p)) {
        const std::size_t count = particles.positions.size() / 3;
        for (std::size_t i = 0; i < 3 * count; ++i)
            velocity.push_back(static_cast<float>(
                std::sin(time + 2.0 * static_cast<double>(particles.positions[i]) + static_cast<double>(i % 3))));
        for (std::size_t i = 0; i < count; ++i) id.push_back(static_cast<std::uint32_t>(4294967295U - 7 * i));
        for (std::size_t i = 0; i < 3 * count; ++i) color.push_back(static_cast<std::uint8_t>(37 * i));
        arrays = {{"color", std::as_bytes(std::span(color)), ElementType::uint8, 3},
                  {"velocity", std::as_bytes(std::span(velocity)), ElementType::float32, 3},
                  {"id", std::as_bytes(std::span(id)), ElementType::uint32, 1}};
    }
    ParticlesWithArrays(const ParticlesWithArrays&) = delete;
    ParticlesWithArrays& operator=(const ParticlesWithArrays&) = delete;

    ParticleFrame view() const {
        ParticleFrame frame = particles.view();
        frame.arrays = arrays;
        return frame;
    }

    Particles particles;
    std::vector<float> velocity;
    std::vector<std::uint32_t> id;
    std::vector<std::uint8_t> color;
    std::vector<ParticleArray> arrays;
};

/// In its canonical order, with the attributes as they come to a receiver that asks for these.
inline Mesh made_here(const ParticleFrame& frame, const Settings& with, const std::vector<AttributeWish>& attributes) {
    Reconstructor reconstructor(with, {.threads = 1});
    Mesh mesh;
    reconstructor.reconstruct(frame, mesh);
    round_attributes(mesh, attributes);
    return in_canonical_order(mesh);
}

inline const std::vector<AttributeWish> all_exact{{.name = {}, .bits = 0}};
inline const std::vector<AttributeWish> all_in_8_bits{{.name = {}, .bits = 8}};

/// Names and bytes.
inline std::vector<std::pair<std::string, std::string>> attributes_of(const Mesh& mesh) {
    std::vector<std::pair<std::string, std::string>> attributes;
    for (const MeshAttribute& attribute : mesh.attributes)
        attributes.emplace_back(
            attribute.name, std::string(reinterpret_cast<const char*>(attribute.data.data()), attribute.data.size()));
    return attributes;
}

}  // namespace meniscus::server::test
