#include "neighbors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace meniscus::benchmarks {
namespace {

/// Of the cell (x, y, z), each within 2^20 of the origin.
std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::int64_t half = 1 << 20;
    return static_cast<std::uint64_t>(x + half) << 42U | static_cast<std::uint64_t>(y + half) << 21U |
           static_cast<std::uint64_t>(z + half);
}

}  // namespace

std::vector<std::size_t> pick_evenly(std::size_t n, std::size_t limit) {
    const std::size_t count = std::min(n, limit);
    std::vector<std::size_t> picked(count);
    for (std::size_t i = 0; i < count; ++i) picked[i] = i * n / count;
    return picked;
}

double mean_neighbors(std::span<const float> particles, std::span<const float> points, float distance) {
    const auto cell = [distance](float value) { return static_cast<std::int64_t>(std::floor(value / distance)); };
    // The few points are looked up by the many particles: every point is entered in the 27 cells around it.
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> points_near;
    for (std::size_t p = 0; p < points.size(); p += 3)
        for (std::int64_t dz = -1; dz <= 1; ++dz)
            for (std::int64_t dy = -1; dy <= 1; ++dy)
                for (std::int64_t dx = -1; dx <= 1; ++dx)
                    points_near[key(cell(points[p]) + dx, cell(points[p + 1]) + dy, cell(points[p + 2]) + dz)]
                        .push_back(p);
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < particles.size(); i += 3) {
        const auto found = points_near.find(key(cell(particles[i]), cell(particles[i + 1]), cell(particles[i + 2])));
        if (found == points_near.end()) continue;
        for (const std::size_t p : found->second) {
            const float x = particles[i] - points[p];
            const float y = particles[i + 1] - points[p + 1];
            const float z = particles[i + 2] - points[p + 2];
            if (x * x + y * y + z * z < distance * distance) ++pairs;
        }
    }
    return static_cast<double>(pairs) / (static_cast<double>(points.size()) / 3.0);
}

}  // namespace meniscus::benchmarks
