// What CLI11's own checks of numbers let through.
#pragma once

#include <CLI/CLI.hpp>

namespace meniscus::server {

/// Of a number that may have a unit, before the unit is looked at: CLI11 takes "-5" for a large number, and one that is
/// too large for the largest.
CLI::Validator whole_number();

/// Of a number from 0 on; CLI11's own range takes "nan".
CLI::Validator up_to(double most);

/// The server counts milliseconds. Less than one would be 0, which is no limit.
CLI::Validator seconds_up_to(double most);

}  // namespace meniscus::server
