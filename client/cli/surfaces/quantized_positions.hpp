// Positions as three uint16 in the frame's bounding box: half the bytes of float32.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::cli {

/// How positions are uploaded.
enum class PositionEncoding { float32, uint16 };
constexpr std::string_view name_of(PositionEncoding encoding) {
    switch (encoding) {
        case PositionEncoding::float32:
            return "float32";
        case PositionEncoding::uint16:
            return "uint16";
    }
    return {};
}

class QuantizedPositions {
public:
    /// frame: finite float positions.
    explicit QuantizedPositions(const ParticleFrame& frame);
    /// The frame with quantized positions; borrows this object, and the levels and arrays of the original.
    ParticleFrame frame() const;

private:
    std::vector<std::uint16_t> values_;
    Box box_;
    std::span<const std::uint8_t> levels_;
    std::span<const ParticleArray> arrays_;
};

}  // namespace meniscus::cli
