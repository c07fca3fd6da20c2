// Settings on the wire and in core.
#pragma once

#include <string_view>

#include "meniscus/settings.hpp"
#include "meniscus/v1/settings.pb.h"

namespace meniscus::conversion {

/// Fills the defaults in, those that depend on the field, too. Throws InvalidInput for a missing corner of a box, and
/// for fields and enum values that this version does not know; ranges are core's to check.
Settings from_wire(const v1::Settings& wire);
/// With every default written out. What belongs to one field is sent with another only if it was given, for the
/// receiver to refuse.
v1::Settings to_wire(const Settings& settings);

/// Throws InvalidInput, naming the box, unless both corners are there.
Box from_wire(const v1::Box& wire, std::string_view name);
v1::Box to_wire(const Box& box);

}  // namespace meniscus::conversion
