// The range of an option that is a number.
#pragma once

#include <CLI/CLI.hpp>
#include <iomanip>
#include <sstream>
#include <string>

namespace meniscus::cli {

/// least, most: are in it. CLI::Range, whose text in the help this has, takes "nan", which is beyond neither bound.
inline CLI::Validator number_range(double least, double most) {
    CLI::Validator range = CLI::Range(least, most);
    range.operation([least, most](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return {};
        std::ostringstream refusal;
        refusal << std::setprecision(10) << text << " not in range " << least << " to " << most;
        return refusal.str();
    });
    return range;
}

}  // namespace meniscus::cli
