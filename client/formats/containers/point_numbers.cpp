#include "formats/containers/point_numbers.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

float to_coordinate(double value, std::size_t particle, const ByteCursor& at) {
    constexpr auto limit = static_cast<double>(std::numeric_limits<float>::max());
    if (std::isfinite(value) && std::abs(value) > limit) {
        std::ostringstream message;
        message << "coordinate " << value << " of particle " << particle << " is beyond float32 (at most " << limit
                << ")";
        at.fail(message.str());
    }
    return static_cast<float>(value);
}

std::uint8_t to_level(double value, std::size_t particle, const ByteCursor& at) {
    if (!(value >= 0.0 && value <= double{max_particle_level}) || value != std::floor(value)) {
        std::ostringstream message;
        message << "level " << value << " of particle " << particle << " is not one of 0 to " << max_particle_level;
        at.fail(message.str());
    }
    return static_cast<std::uint8_t>(value);
}

}  // namespace meniscus::formats
