#include "compare/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace meniscus::compare {
namespace {

/// The smallest distance that at least `share` of the weight does not exceed.
double percentile(std::vector<std::pair<double, double>>& distance_weight, double weight, double share) {
    std::sort(distance_weight.begin(), distance_weight.end());
    double sum = 0.0;
    for (const auto& [distance, w] : distance_weight) {
        sum += w;
        if (sum >= share * weight) return distance;
    }
    return distance_weight.back().first;
}

}  // namespace

SurfaceDistance measure(const Samples& from, const TriangleTree& to) {
    SurfaceDistance out;
    std::vector<std::pair<double, double>> distance_weight;
    distance_weight.reserve(from.points.size());
    std::uint32_t hint = 0;
    double weight = 0.0;
    double squares = 0.0;
    for (std::size_t k = 0; k + 1 < from.starts.size(); ++k) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = from.starts[k]; i < from.starts[k + 1]; ++i) {
            const double square = to.squared_distance(from.points[i], hint);
            const double distance = std::sqrt(square);
            nearest = std::min(nearest, distance);
            out.summary.max = std::max(out.summary.max, distance);
            squares += from.weights[i] * square;
            weight += from.weights[i];
            distance_weight.emplace_back(distance, from.weights[i]);
        }
        out.nearest.push_back(nearest);
    }
    out.summary.rms = std::sqrt(squares / weight);
    out.summary.percentile_99 = percentile(distance_weight, weight, 0.99);
    return out;
}

}  // namespace meniscus::compare
