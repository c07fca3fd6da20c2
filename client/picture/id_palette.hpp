// Ids as colors: the same for the same id, different ones for neighbors.
#pragma once

#include <cstdint>

#include "picture/color_maps.hpp"

namespace meniscus::cli {

/// id: of int32 its bits.
Rgb color_of_id(std::uint32_t id);

}  // namespace meniscus::cli
