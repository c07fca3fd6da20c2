// One upload of particles, borrowed from the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "meniscus/element_type.hpp"
#include "meniscus/frame_upload.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// Coarsest particle level of adaptive SPH: level k has radius and support times 2^k and mass times 8^k.
inline constexpr unsigned max_particle_level = 3;

/// Most arrays that a frame can bring beside positions and levels.
inline constexpr std::size_t max_particle_arrays = 16;
/// Most characters of the name of an array that becomes an attribute; they are of a-z, 0-9 and _.
inline constexpr std::size_t max_array_name_bytes = 64;

/// A value that every particle carries beside its position and level, such as a velocity; borrowed.
struct ParticleArray {
    std::string_view name;
    std::span<const std::byte> data;  ///< element_bytes() for each particle, one particle after the other
    ElementType type = ElementType::float32;
    std::size_t components = 1;  ///< numbers per particle, at least 1

    std::size_t element_bytes() const { return size_of(type) * components; }
};

/// Positions in one of two encodings; the other stays empty. Borrowed: the memory must outlive the call. Arrays in
/// pinned memory (cuda::page_pinning(), or CUDA's own functions) go to a GPU without a copy on the way.
struct ParticleFrame {
    std::span<const float> positions;          ///< x y z per particle, world units
    std::span<const std::uint16_t> quantized;  ///< x y z per particle: min + q (max - min) / 65535 of quantization_box
    Box quantization_box;                      ///< used with `quantized` only
    std::span<const std::uint8_t> levels;      ///< empty (uniform SPH), or one per particle, 0 (finest) to 3
    /// Arrays that the settings name become attributes of the mesh's vertices, and order particles that lie at one
    /// place by their bytes; the surface does not depend on them. All others are passed over, whatever values they
    /// hold.
    std::span<const ParticleArray> arrays{};
    const FrameUpload* sent =
        nullptr;  ///< upload of these very arrays by the reconstructor that gets them; may be null

    bool is_quantized() const { return !quantized.empty(); }
    std::size_t count() const { return (is_quantized() ? quantized.size() : positions.size()) / 3; }
};

}  // namespace meniscus
