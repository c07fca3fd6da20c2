#include "load/latencies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace meniscus::load {

double Latencies::mean() const {
    if (seconds_.empty()) return 0.0;
    return std::accumulate(seconds_.begin(), seconds_.end(), 0.0) / static_cast<double>(seconds_.size());
}

double Latencies::percentile(double share) const {
    if (seconds_.empty()) return 0.0;
    std::vector<double> ordered = seconds_;
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(ordered.size())));
    const auto at = ordered.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, ordered.size()) - 1);
    std::nth_element(ordered.begin(), at, ordered.end());
    return *at;
}

}  // namespace meniscus::load
