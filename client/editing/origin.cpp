#include "editing/origin.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::editing {

void move_to(formats::Particles& particles, const Origin& origin) {
    for (std::size_t i = 0; i < particles.positions.size(); ++i) {
        const double x = particles.coordinate(i) - origin[i % 3];
        particles.positions[i] = static_cast<float>(x);
        if (!particles.remainders.empty())
            particles.remainders[i] = static_cast<float>(x - static_cast<double>(particles.positions[i]));
    }
}

void move_from(formats::TriangleMesh& mesh, const Origin& origin) {
    for (std::array<double, 3>& x : mesh.positions)
        for (std::size_t a = 0; a < 3; ++a) x[a] += origin[a];
    mesh.wide = true;
}

double largest_remainder(const formats::Particles& particles) {
    double largest = 0.0;
    for (const float x : particles.remainders) largest = std::max(largest, std::abs(static_cast<double>(x)));
    return largest;
}

Origin middle_of(const formats::Particles& particles) {
    Origin middle{};
    for (std::size_t a = 0; a < 3 && particles.count() > 0; ++a) {
        double low = particles.coordinate(a), high = low;
        for (std::size_t i = a; i < particles.positions.size(); i += 3) {
            low = std::min(low, particles.coordinate(i));
            high = std::max(high, particles.coordinate(i));
        }
        middle[a] = std::round(low + (high - low) / 2.0);
    }
    return middle;
}

}  // namespace meniscus::editing
