// A check of options that must have something in them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace meniscus::cli {

/// Refuses what a variable of a script leaves that is not set, and what would otherwise be taken for an option that is
/// not given. wanted: what it must be.
inline CLI::Validator not_empty(const std::string& wanted) {
    return {[wanted](const std::string& text) { return text.empty() ? "empty, must be " + wanted : std::string(); },
            ""};
}

}  // namespace meniscus::cli
