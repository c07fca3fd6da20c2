// Checks of numbers that CLI11's own checks let through.
#pragma once

#include <CLI/CLI.hpp>

namespace meniscus::server {

/// Checks a number that may have a unit, before the unit is looked at. CLI11 takes "-5" for a large number, and a
/// number that is too large for the largest.
CLI::Validator whole_number();

/// Checks that a number is from 0 to this one. CLI11's own range takes "nan".
CLI::Validator up_to(double most);

/// The server counts milliseconds. Less than one would be 0, which is no limit.
CLI::Validator seconds_up_to(double most);

}  // namespace meniscus::server
