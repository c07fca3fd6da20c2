// How much there is to sum.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace meniscus::benchmarks {

/// Points picked evenly from n, at most `limit` of them: their indices.
std::vector<std::size_t> pick_evenly(std::size_t n, std::size_t limit);

/// The mean number of particles within `distance` of a point. Both x y z each, world units; at least one point.
double mean_neighbors(std::span<const float> particles, std::span<const float> points, float distance);

}  // namespace meniscus::benchmarks
