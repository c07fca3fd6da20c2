// The arrays that a frame of particles consists of on the wire, and where their bytes lie.
#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meniscus/particle_frame.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::conversion {

using ParticleArrays = google::protobuf::RepeatedPtrField<v1::ParticleArray>;

/// Positions, levels, and as many more as a ParticleFrame can bring.
inline constexpr int max_announced_arrays = 2 + static_cast<int>(max_particle_arrays);
inline constexpr std::uint32_t max_array_components = 16;

/// An array beside positions and levels.
struct FurtherArray {
    std::string name;
    std::optional<ElementType> type;  ///< none: uint16, of which particles carry positions alone
    std::size_t components = 1;
    std::uint64_t bytes = 0;  ///< per particle
    std::uint64_t after = 0;  ///< bytes per particle of the arrays before it

    bool can_be_attribute() const { return type && meniscus::can_be_attribute(*type, components); }
};
/// Its form, such as "float32 of 3 components".
std::string form_of(const FurtherArray& array);

/// Positions come first.
struct ParticleLayout {
    bool quantized = false;             ///< positions are three uint16 over the quantization box; else three float32
    bool has_levels = false;            ///< one uint8 per particle
    std::uint64_t position_bytes = 0;   ///< per particle
    std::uint64_t levels_after = 0;     ///< bytes per particle of the arrays before the levels
    std::uint64_t particle_bytes = 0;   ///< per particle, of all arrays
    std::vector<FurtherArray> further;  ///< in their order; a reader takes those that it knows a use for
};

/// Throws InvalidInput, with the array's name, the value and what is allowed, for a list that is too long, that lacks
/// positions in its first place, or that holds an array twice, of a type or a number of components that none has, or
/// positions or levels of others than theirs.
ParticleLayout particle_layout(const ParticleArrays& arrays);

/// The list of a frame as this version writes it: positions, levels, then these.
ParticleArrays particle_arrays(bool quantized, bool has_levels, std::span<const ParticleArray> further = {});

}  // namespace meniscus::conversion
