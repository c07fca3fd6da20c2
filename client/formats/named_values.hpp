// Values that the particles or the vertices of a file carry.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// One array, owned.
struct NamedValues {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;   ///< numbers per particle or vertex
    std::vector<std::byte> data;  ///< in the machine's byte order, one particle after the other

    std::size_t element_bytes() const { return size_of(type) * components; }
    std::size_t count() const { return data.size() / element_bytes(); }
    ParticleArray view() const { return {name, data, type, components}; }
};

inline std::vector<ParticleArray> views_of(std::span<const NamedValues> arrays) {
    std::vector<ParticleArray> views;
    for (const NamedValues& values : arrays) views.push_back(values.view());
    return views;
}

}  // namespace meniscus::formats
