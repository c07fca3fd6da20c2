// An attack, and the figures that it measures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meniscus::hostile {

/// A measured value beside the most that it may be.
struct Figure {
    std::string what;
    double value = 0.0;
    double limit = 0.0;
    std::string unit;

    bool holds() const noexcept { return value <= limit; }  ///< not for NaN
};

struct Attack {
    std::string_view name;
    std::string_view what;  ///< one line for the report
    /// Starts servers of its own from the program meniscusd, attacks them, and ends them. Throws std::exception where
    /// the attack itself cannot be made.
    std::vector<Figure> (*run)(const std::string& program);
};

}  // namespace meniscus::hostile
