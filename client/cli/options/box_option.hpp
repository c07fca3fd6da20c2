// An option that takes a box.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "meniscus/settings.hpp"

namespace meniscus::cli {

/// X0 Y0 Z0 X1 Y1 Z1, world units. box: set when the option is given; outlives the parsing. Refuses a box whose corners
/// are the other way round.
CLI::Option* add_box_option(CLI::App& command, const std::string& flag, std::optional<Box>& box,
                            const std::string& description);

}  // namespace meniscus::cli
