#include "editing/particle_box.hpp"

#include <cmath>
#include <cstring>
#include <vector>

namespace meniscus::editing {
namespace {

std::vector<std::size_t> those_inside(const formats::Particles& particles, const Box& box) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < particles.count(); ++i) {
        bool outside = false;
        for (std::size_t a = 0; a < 3; ++a) {
            const double x = particles.coordinate(3 * i + a);
            outside = outside || (std::isfinite(x) && (x < box.min[a] || x > box.max[a]));
        }
        if (!outside) kept.push_back(i);
    }
    return kept;
}

/// Elements of `size` values each; those that are kept move to the front, since none moves backwards.
template <class Value>
void keep(std::vector<Value>& values, std::size_t size, const std::vector<std::size_t>& kept) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i)
        std::memmove(values.data() + i * size, values.data() + kept[i] * size, size * sizeof(Value));
    values.resize(kept.size() * size);
}

}  // namespace

void keep_inside(formats::Particles& particles, const Box& box) {
    const std::vector<std::size_t> kept = those_inside(particles, box);
    if (kept.size() == particles.count()) return;
    keep(particles.positions, 3, kept);
    keep(particles.remainders, 3, kept);
    keep(particles.levels, 1, kept);
    for (formats::NamedValues& array : particles.arrays) keep(array.data, array.element_bytes(), kept);
}

}  // namespace meniscus::editing
