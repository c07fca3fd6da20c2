#include "compare/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compare/triangle_distance.hpp"
#include "compare/vector_math.hpp"

namespace meniscus::compare {
namespace {

/// Numbers in [0, 1), the same sequence always (SplitMix64).
class Random {
public:
    double next() {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t x = state_;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ULL;
        x = (x ^ x >> 27) * 0x94d049bb133111ebULL;
        x ^= x >> 31;
        return static_cast<double>(x >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 0;
};

Point point_in(const std::array<Point, 3>& triangle, Random& random) {
    double u = random.next();
    double v = random.next();
    if (u + v > 1.0) {  // the other half of the parallelogram
        u = 1.0 - u;
        v = 1.0 - v;
    }
    const Point along = add_scaled(triangle[0], u, subtract(triangle[1], triangle[0]));
    return add_scaled(along, v, subtract(triangle[2], triangle[0]));
}

}  // namespace

double Samples::area() const {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

Samples sample(SurfaceView surface, const Components& components, std::size_t count) {
    std::vector<double> sums(components.count(), 0.0);
    for (std::size_t k = 0; k < components.count(); ++k)
        for (std::size_t i = components.starts[k]; i < components.starts[k + 1]; ++i)
            sums[k] += area(surface.corners(surface.triangles[components.triangles[i]]));
    const double total = std::accumulate(sums.begin(), sums.end(), 0.0);

    Samples samples;
    Random random;
    samples.starts.push_back(0);
    for (std::size_t k = 0; k < components.count(); ++k) {
        const auto share = static_cast<std::size_t>(std::ceil(static_cast<double>(count) * (sums[k] / total)));
        const std::size_t n = std::max(share, fewest_samples_per_component);
        const double step = sums[k] / static_cast<double>(n);
        std::size_t at = components.starts[k];
        double covered = area(surface.corners(surface.triangles[components.triangles[at]]));
        for (std::size_t i = 0; i < n; ++i) {
            const double wanted = (static_cast<double>(i) + random.next()) * step;
            while (covered < wanted && at + 1 < components.starts[k + 1])
                covered += area(surface.corners(surface.triangles[components.triangles[++at]]));
            samples.points.push_back(point_in(surface.corners(surface.triangles[components.triangles[at]]), random));
            samples.weights.push_back(step);
        }
        samples.starts.push_back(samples.points.size());
    }
    return samples;
}

}  // namespace meniscus::compare
