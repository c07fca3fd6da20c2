// The arrays that a frame of particles consists of on the wire, and where their bytes lie.
#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <cstddef>
#include <cstdint>

#include "meniscus/particle_frame.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::conversion {

using ParticleArrays = google::protobuf::RepeatedPtrField<v1::ParticleArray>;

/// Positions, levels, and as many more as a ParticleFrame can bring.
inline constexpr int max_announced_arrays = 2 + static_cast<int>(max_particle_arrays);
inline constexpr std::uint32_t max_array_components = 16;
inline constexpr std::size_t max_array_name_bytes = 64;

/// Positions come first.
struct ParticleLayout {
    bool quantized = false;            ///< positions are three uint16 over the quantization box; else three float32
    bool has_levels = false;           ///< one uint8 per particle
    std::uint64_t position_bytes = 0;  ///< per particle
    std::uint64_t levels_after = 0;    ///< bytes per particle of the arrays before the levels
    std::uint64_t particle_bytes = 0;  ///< per particle, of all arrays
};

enum class UnknownArrays { refuse, skip };

/// unknown: what happens to arrays whose names this version does not know. Throws InvalidInput, with the array's name,
/// the value and what is allowed, for a list that is too long, that lacks positions in its first place, or that holds
/// an array twice, of another type or of another number of components than it has.
ParticleLayout particle_layout(const ParticleArrays& arrays, UnknownArrays unknown);

/// The list of a frame as this version writes it.
ParticleArrays particle_arrays(bool quantized, bool has_levels);

}  // namespace meniscus::conversion
