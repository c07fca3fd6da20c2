// Values that the particles or the vertices of a file carry.
#pragma once

#include <cstddef>
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

/// As a ParticleFrame has them; borrowed.
inline std::vector<ParticleArray> views(const std::vector<NamedValues>& arrays) {
    std::vector<ParticleArray> out;
    out.reserve(arrays.size());
    for (const NamedValues& array : arrays) out.push_back(array.view());
    return out;
}

}  // namespace meniscus::formats
