// Boxes of bricks as Python gives them.
#pragma once

#include <pybind11/pybind11.h>

#include "meniscus/brick_box.hpp"

namespace meniscus::python {

/// given: (lowest, highest), each x y z, a number or None for no end; None: all bricks. Throws InvalidInput, with the
/// name, for anything else.
BrickBox brick_box(const pybind11::object& given, const char* name);

}  // namespace meniscus::python
