// Values that the particles or the vertices of a file carry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// One array, owned.
struct NamedValues {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;   ///< numbers per particle or vertex
    std::vector<std::byte> data;  ///< in the machine's byte order, one particle after the other
    std::string label{};          ///< what its file calls it, where `name` is made of that; empty: as `name`

    std::size_t element_bytes() const { return size_of(type) * components; }
    std::size_t count() const { return data.size() / element_bytes(); }
    ParticleArray view() const { return {name, data, type, components}; }
};

/// The arrays as a ParticleFrame has them; borrowed.
inline std::vector<ParticleArray> views(const std::vector<NamedValues>& arrays) {
    std::vector<ParticleArray> out;
    out.reserve(arrays.size());
    for (const NamedValues& array : arrays) out.push_back(array.view());
    return out;
}

/// A frame's arrays, and before them its levels, if it has some, as one of this name.
inline std::vector<ParticleArray> with_levels(const ParticleFrame& frame, std::string_view name) {
    std::vector<ParticleArray> out;
    if (!frame.levels.empty()) out.push_back({name, std::as_bytes(frame.levels), ElementType::uint8, 1});
    out.insert(out.end(), frame.arrays.begin(), frame.arrays.end());
    return out;
}

/// The name of an array in a file where some names mean something else: those get a _.
inline std::string name_beside(std::initializer_list<std::string_view> taken, std::string_view name) {
    const bool clashes = std::find(taken.begin(), taken.end(), name) != taken.end();
    return std::string(name) + (clashes ? "_" : "");
}

}  // namespace meniscus::formats
