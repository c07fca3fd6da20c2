// The figures of a pickled mesh.
#pragma once

#include <optional>
#include <string>

#include "meniscus/statistics.hpp"

namespace meniscus::python {

/// As bytes. A build without the service, which alone writes them to a file (.bricks), gives none and reads none.
std::string figure_bytes(const Statistics& figures);
/// Nothing for what are no figures.
std::optional<Statistics> figures_of(const std::string& bytes);

}  // namespace meniscus::python
