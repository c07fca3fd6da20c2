// Settings by name, as the keywords of meniscus.Reconstructor.
#pragma once

#include <pybind11/pybind11.h>

#include "meniscus/settings.hpp"

namespace meniscus::python {

/// All of them, with the defaults in force; None for those that the others leave without meaning. As keywords they make
/// the same settings.
pybind11::dict to_dict(const Settings& settings);

}  // namespace meniscus::python
