#include "growth.hpp"

#include <cstddef>
#include <numeric>

namespace meniscus::soak {

double growth(std::span<const double> sizes) {
    if (sizes.size() < 2) return 0.0;
    const auto count = static_cast<double>(sizes.size());
    const double middle = (count - 1.0) / 2.0;
    const double mean = std::accumulate(sizes.begin(), sizes.end(), 0.0) / count;
    double with_time = 0.0;
    double of_time = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double time = static_cast<double>(i) - middle;
        with_time += time * (sizes[i] - mean);
        of_time += time * time;
    }
    return with_time / of_time * (count - 1.0);
}

}  // namespace meniscus::soak
