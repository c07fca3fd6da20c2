// The flag --normal-bits.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace meniscus::cli {

/// value: an int, or an optional one; outlives the parsing.
template <class Value>
CLI::Option* add_normal_bits(CLI::App& command, Value& value, const std::string& otherwise) {
    std::vector<int> allowed(16);
    std::iota(allowed.begin() + 1, allowed.end(), 2);  // 0, and 2 to 16
    CLI::Validator check = CLI::IsMember(allowed);     // names them in --help, but says nothing of what is no number
    check.operation([allowed](const std::string& text) -> std::string {
        const auto is_text = [&](int bits) { return std::to_string(bits) == text; };
        if (std::any_of(allowed.begin(), allowed.end(), is_text)) return {};
        return text + " is not 0 or a whole number from 2 to 16";
    });
    return command
        .add_option("--normal-bits", value,
                    "Bits per component of the normals, 0 or 2 to 16; 0: no normals" + otherwise)
        ->check(check);
}

}  // namespace meniscus::cli
