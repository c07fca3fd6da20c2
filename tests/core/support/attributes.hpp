// Frames whose particles carry arrays of any form, and the same frames in another order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "meniscus/mesh.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus::test {

/// Owns the arrays that frame() borrows.
struct ParticlesWithArrays {
    Particles particles;
    std::vector<std::string> names;
    std::vector<ParticleArray> arrays;  ///< without data
    std::vector<std::vector<std::byte>> bytes;

    /// value(particle, component)
    template <class T, class Value>
    void add(const std::string& name, ElementType type, std::size_t components, const Value& value) {
        std::vector<std::byte> data(particles.count() * components * sizeof(T));
        for (std::size_t i = 0; i < particles.count() * components; ++i) {
            const T number = static_cast<T>(value(i / components, i % components));
            std::memcpy(data.data() + i * sizeof(T), &number, sizeof number);
        }
        names.push_back(name);
        bytes.push_back(std::move(data));
        arrays.push_back({{}, {}, type, components});
    }
    template <class Value>
    void add_floats(const std::string& name, std::size_t components, const Value& value) {
        add<float>(name, ElementType::float32, components, value);
    }

    ParticleFrame frame() {
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            arrays[a].name = names[a];
            arrays[a].data = bytes[a];
        }
        ParticleFrame f = particles.frame();
        f.arrays = arrays;
        return f;
    }
    template <class T>
    T value(std::size_t array, std::size_t particle, std::size_t component) const {
        T number{};
        std::memcpy(&number, bytes[array].data() + (particle * arrays[array].components + component) * sizeof(T),
                    sizeof number);
        return number;
    }

    ParticlesWithArrays shuffled(unsigned seed) const {
        std::vector<std::size_t> order(particles.count());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), std::mt19937(seed));
        ParticlesWithArrays other;
        other.names = names;
        other.arrays = arrays;
        for (const std::size_t i : order) {
            other.particles.add(particles.positions[3 * i], particles.positions[3 * i + 1],
                                particles.positions[3 * i + 2]);
            if (!particles.levels.empty()) other.particles.levels.push_back(particles.levels[i]);
        }
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            const std::size_t size = arrays[a].element_bytes();
            auto& to = other.bytes.emplace_back();
            for (const std::size_t i : order) {
                const auto from = bytes[a].begin() + static_cast<std::ptrdiff_t>(i * size);
                to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(size));
            }
        }
        return other;
    }
};

/// White noise in arrays of every form that can be an attribute, "a_" and a number: more amounts than one group holds.
inline ParticlesWithArrays with_noise(const Particles& particles, unsigned seed) {
    ParticlesWithArrays p;
    p.particles = particles;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> real(-1.0F, 1.0F);
    const auto name = [&] { return "a_" + std::to_string(p.names.size()); };
    for (const std::size_t components : {3U, 1U, 4U})
        p.add_floats(name(), components, [&](std::size_t, std::size_t) { return real(random); });
    for (const std::size_t components : {4U, 1U, 3U})
        p.add<std::uint8_t>(name(), ElementType::uint8, components,
                            [&](std::size_t, std::size_t) { return random() % 256; });
    p.add<std::uint32_t>(name(), ElementType::uint32, 1, [&](std::size_t, std::size_t) { return random(); });
    p.add<std::int32_t>(name(), ElementType::int32, 1, [&](std::size_t, std::size_t) { return random() % 7 - 3; });
    return p;
}

template <class T>
T vertex_value(const MeshAttribute& attribute, std::size_t vertex, std::size_t component = 0) {
    T number{};
    std::memcpy(&number, attribute.data.data() + (vertex * attribute.components + component) * sizeof(T),
                sizeof number);
    return number;
}

/// Expects the same attributes, to the bit.
inline bool same_attributes(const Mesh& a, const Mesh& b) {
    if (a.attributes.size() != b.attributes.size()) return false;
    for (std::size_t i = 0; i < a.attributes.size(); ++i)
        if (a.attributes[i].name != b.attributes[i].name || a.attributes[i].type != b.attributes[i].type ||
            a.attributes[i].components != b.attributes[i].components ||
            !same_bytes(a.attributes[i].data, b.attributes[i].data))
            return false;
    return true;
}

}  // namespace meniscus::test
