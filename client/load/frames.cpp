#include "load/frames.hpp"

#include "formats/particles/particle_file.hpp"
#include "load/moving_water.hpp"

namespace meniscus::load {

Frames Frames::moving_water(std::size_t particles, double particle_radius) {
    constexpr int period = 16;
    Frames frames;
    for (int i = 0; i < period; ++i)
        frames.frames_.push_back(
            {.positions = load::moving_water(particles, particle_radius, i / double{period}), .levels = {}});
    return frames;
}

Frames Frames::read(const std::vector<std::string>& paths) {
    Frames frames;
    for (const std::string& path : paths) frames.frames_.push_back(formats::read_particles(path));
    return frames;
}

ParticleFrame Frames::at(std::uint64_t frame) const {
    const formats::Particles& particles = frames_[frame % frames_.size()];
    return {.positions = particles.positions, .quantized = {}, .quantization_box = {}, .levels = particles.levels};
}

}  // namespace meniscus::load
