#include "particles.hpp"

#include <cstddef>
#include <limits>
#include <string>

#include "meniscus/error.hpp"
#include "sized_struct.hpp"

namespace meniscus::c {
namespace {

/// The struct itself, once it makes sense.
meniscus_particles checked(const meniscus_particles* particles) {
    const meniscus_particles given = read_struct(particles, "particles");
    constexpr std::size_t most = std::numeric_limits<std::ptrdiff_t>::max() / (3 * sizeof(double));
    if (given.count > most)
        throw InvalidInput("particles->count is " + std::to_string(given.count) + ", more than memory can hold");
    if (given.count != 0 && (given.positions == nullptr) == (given.positions_double == nullptr))
        throw InvalidInput(std::string("particles->positions and particles->positions_double are ") +
                           (given.positions == nullptr ? "both NULL" : "both set") + ", must be one of them, for " +
                           std::to_string(given.count) + " particles");
    return given;
}

template <class Number>
StridedPositions strided(const Number* first, const meniscus_particles& given) {
    return {first, given.count, given.stride == 0 ? 3 * sizeof(Number) : given.stride};
}

StridedPositions positions_of(const meniscus_particles& given) {
    return given.positions_double != nullptr ? strided(given.positions_double, given) : strided(given.positions, given);
}

std::span<const std::uint8_t> levels_of(const meniscus_particles& given) {
    if (given.levels == nullptr) return {};
    return {given.levels, given.count};
}

}  // namespace

GivenParticles read_particles(const meniscus_particles* particles) {
    const meniscus_particles given = checked(particles);
    return {positions_of(given), levels_of(given)};
}

ParticleFrame read_frame(const meniscus_particles* particles, std::vector<float>& buffer) {
    const meniscus_particles given = checked(particles);
    ParticleFrame frame;
    frame.levels = levels_of(given);
    if (given.positions != nullptr && (given.stride == 0 || given.stride == 3 * sizeof(float))) {
        frame.positions = {given.positions, 3 * given.count};
    } else {
        buffer.resize(3 * given.count);
        positions_of(given).copy_to(buffer);
        frame.positions = buffer;
    }
    return frame;
}

}  // namespace meniscus::c
