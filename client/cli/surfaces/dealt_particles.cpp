#include "cli/surfaces/dealt_particles.hpp"

#include <span>

namespace meniscus::cli {
namespace {

/// length: numbers for each particle.
template <class Number>
std::vector<Number> dealt(std::span<const Number> numbers, std::size_t length, std::uint32_t part,
                          std::uint32_t parts) {
    std::vector<Number> mine;
    for (std::size_t i = part * length; i < numbers.size(); i += parts * length) {
        const auto of_particle = numbers.subspan(i, length);
        mine.insert(mine.end(), of_particle.begin(), of_particle.end());
    }
    return mine;
}

}  // namespace

DealtParticles::DealtParticles(const ParticleFrame& frame, std::uint32_t part, std::uint32_t parts)
    : positions_(dealt(frame.positions, 3, part, parts)), levels_(dealt(frame.levels, 1, part, parts)) {
    for (const ParticleArray& array : frame.arrays) {
        values_.push_back(dealt(array.data, array.element_bytes(), part, parts));
        ParticleArray mine = array;
        mine.data = values_.back();  // whose bytes stay where they are
        arrays_.push_back(mine);
    }
}

ParticleFrame DealtParticles::frame() const {
    ParticleFrame view;
    view.positions = positions_;
    view.levels = levels_;
    view.arrays = arrays_;
    return view;
}

}  // namespace meniscus::cli
