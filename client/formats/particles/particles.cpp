#include "formats/particles/particles.hpp"

#include <algorithm>
#include <cmath>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/containers/point_numbers.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::formats {

std::string corners_as_particles(std::size_t faces, std::size_t particles) {
    return "the file has " + std::to_string(faces) + " faces, so that it is a mesh: its " + std::to_string(particles) +
           " corners are taken as particles";
}

void require_arrays(const std::string& file, const Particles& particles, std::span<const std::string> names) {
    for (const std::string& name : names)
        if (std::none_of(particles.arrays.begin(), particles.arrays.end(),
                         [&](const NamedValues& array) { return array.name == name; }))
            throw InvalidInput(file + ": no array " + quoted(name) + "; the file " +
                               described(particles.arrays, particles.left_out));
}

void set_coordinate(Particles& particles, std::size_t index, double value, const ByteCursor& at) {
    const float rounded = to_coordinate(value, index / 3, at);
    if (index == particles.positions.size())
        particles.positions.push_back(rounded);
    else
        particles.positions[index] = rounded;
    if (particles.remainders.empty() && (static_cast<double>(rounded) == value || !std::isfinite(value))) return;
    if (particles.remainders.size() <= index) particles.remainders.resize(index + 1);
    particles.remainders[index] = static_cast<float>(value - static_cast<double>(rounded));
}

}  // namespace meniscus::formats
