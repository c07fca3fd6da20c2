// Whether a series of sizes grows.
#pragma once

#include <span>

namespace meniscus::soak {

/// By how much the straight line through the sizes (least squares) rises from the first to the last. 0 for fewer than
/// two.
double growth(std::span<const double> sizes);

}  // namespace meniscus::soak
