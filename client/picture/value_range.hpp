// The numbers from the least to the greatest, and round ones among them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace meniscus::cli {

struct ValueRange {
    double low = 0.0;
    double high = 0.0;
};

/// With zero in the middle, where it lies within.
ValueRange around_zero(const ValueRange& range);

/// Where the value lies, from 0 to 1; in the middle of a range without extent.
double part_of(double value, const ValueRange& range);

/// Multiples of 1, 2 or 5 times a power of ten, in the range: as many as there can be, at most `most` (at least 1).
std::vector<double> ticks(const ValueRange& range, std::size_t most);

/// To a thousandth of the extent; where there is none, four digits.
std::string value_text(double value, double extent);

}  // namespace meniscus::cli
