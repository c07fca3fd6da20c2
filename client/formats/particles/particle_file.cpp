#include "formats/particles/particle_file.hpp"

#include <string>
#include <vector>

#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {

Particles read_particles(const std::filesystem::path& path, std::optional<ParticleFormat> format,
                         const ReadLimits& limits) {
    if (!format) format = particle_format_of(path);
    const std::string bytes = read_input(path, limits.most_bytes);
    return row_of(*format)->read(input_name(path), bytes, limits);
}

void write_particles(const std::filesystem::path& path, const Particles& particles, ParticleFormat format) {
    const std::vector<ParticleArray> arrays = views(particles.arrays);
    ParticleFrame frame = particles.frame();
    frame.arrays = arrays;
    write_particles(path, frame, format);
}

void write_particles(const std::filesystem::path& path, const ParticleFrame& frame, ParticleFormat format) {
    if (const auto write = row_of(format)->write; write != nullptr) return write(path, frame);
    std::vector<std::string_view> written;
    for (const ParticleFormat known : written_particle_formats()) written.push_back(name_of(known));
    throw InvalidInput(output_name(path) + ": particles are written as " + listed(written) + ", not as " +
                       std::string(name_of(format)));
}

}  // namespace meniscus::formats
