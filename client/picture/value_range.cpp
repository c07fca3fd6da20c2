#include "picture/value_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace meniscus::cli {

ValueRange around_zero(const ValueRange& range) {
    if (range.low >= 0.0 || range.high <= 0.0) return range;
    const double end = std::max(-range.low, range.high);
    return {-end, end};
}

double part_of(double value, const ValueRange& range) {
    return range.high > range.low ? (value - range.low) / (range.high - range.low) : 0.5;
}

std::vector<double> ticks(const ValueRange& range, std::size_t most) {
    const double extent = range.high - range.low;
    if (!(extent > 0.0)) return {range.low};
    const double power = std::pow(10.0, std::floor(std::log10(extent / static_cast<double>(most))));
    for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0}) {
        const double step = factor * power;
        const double first = std::ceil(range.low / step - 1e-9);
        const double last = std::floor(range.high / step + 1e-9);
        if (last - first >= static_cast<double>(most)) continue;
        std::vector<double> found;
        for (int i = 0; first + i <= last; ++i) found.push_back((first + i) * step);
        return found;
    }
    return {};
}

std::string value_text(double value, double extent) {
    const auto order = [](double x) { return std::floor(std::log10(std::abs(x))); };
    const double digits = extent > 0.0 ? order(value) - order(extent) + 4.0 : 4.0;
    if (!(digits >= 1.0) || value == 0.0) return "0";
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*g", static_cast<int>(std::min(digits, 15.0)), value);
    return text.data();
}

}  // namespace meniscus::cli
