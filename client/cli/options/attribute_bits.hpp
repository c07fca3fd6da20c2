// The flag --attribute-bits.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "meniscus/attribute_coding.hpp"

namespace meniscus::cli {

/// value: outlives the parsing.
inline CLI::Option* add_attribute_bits(CLI::App& command, int& value) {
    return command
        .add_option("--attribute-bits", value,
                    "Bits per component of float32 attributes, over the frame's range, 1 to " +
                        std::to_string(max_attribute_bits) + "; 0: exact")
        ->check(CLI::Range(0, max_attribute_bits))
        ->capture_default_str();
}

}  // namespace meniscus::cli
