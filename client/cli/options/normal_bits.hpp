// The flag --normal-bits.
#pragma once

#include <CLI/CLI.hpp>
#include <numeric>
#include <vector>

namespace meniscus::cli {

/// value: an int, or an optional one; outlives the parsing.
template <class Value>
CLI::Option* add_normal_bits(CLI::App& command, Value& value, const std::string& otherwise) {
    std::vector<int> allowed(16);
    std::iota(allowed.begin() + 1, allowed.end(), 2);  // 0, and 2 to 16
    return command
        .add_option("--normal-bits", value,
                    "Bits per component of the normals, 0 or 2 to 16; 0: no normals" + otherwise)
        ->check(CLI::IsMember(allowed));
}

}  // namespace meniscus::cli
