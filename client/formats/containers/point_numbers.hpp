// Numbers of a file's points: untrusted ones that are to be coordinates or levels.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/bytes/byte_cursor.hpp"

namespace meniscus::formats {

/// A coordinate as float32. Throws InvalidInput, naming the particle, if a finite value is beyond float32.
float to_coordinate(double value, std::size_t particle, const ByteCursor& at);
/// A particle level. Throws InvalidInput, naming the particle, unless it is 0 to max_particle_level.
std::uint8_t to_level(double value, std::size_t particle, const ByteCursor& at);

}  // namespace meniscus::formats
