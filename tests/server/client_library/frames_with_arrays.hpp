// Frames with levels, arrays and spray, and what is compared of their surfaces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/canonical_order.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/mesh_hash.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {

/// Particles with levels and arrays, of which any can be taken out.
struct Dealt {
    Particles particles;
    std::vector<float> velocity;
    std::vector<std::uint8_t> color;
    std::vector<std::uint32_t> id;

    std::size_t count() const { return id.size(); }
    ParticleFrame view(std::vector<ParticleArray>& arrays) const {
        arrays = {{"velocity", std::as_bytes(std::span(velocity)), ElementType::float32, 3},
                  {"color", std::as_bytes(std::span(color)), ElementType::uint8, 3},
                  {"id", std::as_bytes(std::span(id)), ElementType::uint32, 1}};
        ParticleFrame frame = particles.view();
        frame.arrays = arrays;
        return frame;
    }
    Dealt only(const std::vector<std::size_t>& chosen) const {
        Dealt part;
        part.particles.box = particles.box;
        for (const std::size_t i : chosen) {
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
                if (!particles.positions.empty()) part.particles.positions.push_back(particles.positions[k]);
                if (!particles.quantized.empty()) part.particles.quantized.push_back(particles.quantized[k]);
                part.velocity.push_back(velocity[k]);
                part.color.push_back(color[k]);
            }
            if (!particles.levels.empty()) part.particles.levels.push_back(particles.levels[i]);
            part.id.push_back(id[i]);
        }
        return part;
    }
};

inline Dealt with_arrays(Particles particles, std::uint32_t seed, bool levels) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> speed(-1.0F, 1.0F);
    Dealt made;
    made.particles = std::move(particles);
    const std::size_t count = std::max(made.particles.positions.size(), made.particles.quantized.size()) / 3;
    for (std::size_t i = 0; i < 3 * count; ++i) {
        made.velocity.push_back(speed(random));
        made.color.push_back(static_cast<std::uint8_t>(random()));
    }
    for (std::size_t i = 0; i < count; ++i) {
        made.id.push_back(static_cast<std::uint32_t>(random() % 50));  // some have all values in common
        if (levels) made.particles.levels.push_back(static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 3 : 0));
    }
    return made;
}

/// Uniformly random places, some of them twice.
inline Particles noise(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(0.0F, static_cast<float>(radius) * 24.0F);
    Particles particles;
    for (std::size_t i = 0; i < 3 * count; ++i) particles.positions.push_back(place(random));
    const std::vector<float> again(particles.positions.begin(), particles.positions.begin() + 90);
    particles.positions.insert(particles.positions.end(), again.begin(), again.end());
    return particles;
}

inline std::vector<Dealt> all_frames() {
    std::vector<Dealt> frames;
    frames.push_back(with_arrays(wave(7, 0.3), 1, false));
    frames.push_back(with_arrays(noise(900, 5), 2, true));
    frames.push_back(with_arrays(quantized(wave(7, 1.7)), 3, false));
    frames.push_back(with_arrays(spray(4), 4, false));
    frames.push_back(with_arrays(noise(400, 6), 5, false));
    frames.push_back({});
    frames.push_back(with_arrays(wave(6, 2.0), 6, true));
    return frames;
}

inline Settings all_settings() {
    Settings with = settings();
    with.attributes = {"velocity", "color", "id"};
    with.spray = Spray::points;
    return with;
}

/// Mesh, attributes and spray, to the bit.
inline std::string fingerprint(const client::ReceivedFrame& frame) {
    const Mesh mesh = in_canonical_order(frame.mesh());
    std::string text = mesh_sha256(mesh);
    for (const MeshAttribute& attribute : mesh.attributes) {
        text += " " + attribute.name + " ";
        text.append(reinterpret_cast<const char*>(attribute.data.data()), attribute.data.size());
    }
    text += " spray ";
    for (const Point& point : mesh.spray) text.append(reinterpret_cast<const char*>(&point), sizeof point);
    return text;
}

}  // namespace meniscus::server::test
