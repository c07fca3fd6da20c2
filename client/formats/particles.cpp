#include "formats/particles.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "formats/byte_cursor.hpp"
#include "formats/extension.hpp"
#include "formats/scalar.hpp"
#include "formats/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

ParticleFormat particle_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".vtk") return ParticleFormat::vtk;
    if (extension == ".ply") return ParticleFormat::ply;
    if (extension == ".xyz" || extension == ".bin" || extension == ".raw") return ParticleFormat::xyz;
    throw InvalidInput(path.string() + ": particle files end in .vtk, .ply, .xyz, .bin or .raw, not in '" + extension +
                       "'");
}

Particles read_particles(const std::filesystem::path& path, std::optional<ParticleFormat> format) {
    if (!format) format = particle_format_of(path);
    const std::string bytes = read_input(path);
    const std::string name = input_name(path);
    switch (*format) {
        case ParticleFormat::vtk:
            return read_vtk(name, bytes);
        case ParticleFormat::ply:
            return read_particle_ply(name, bytes);
        case ParticleFormat::xyz:
            return read_xyz(name, bytes);
    }
    return {};
}

Particles read_xyz(const std::string& name, std::string_view bytes) {
    constexpr std::size_t particle_bytes = 3 * sizeof(float);
    if (bytes.size() % particle_bytes != 0)
        ByteCursor(name, bytes)
            .fail("its size is " + std::to_string(bytes.size()) + " bytes, not a multiple of " +
                  std::to_string(particle_bytes) + " (three float32 per particle)");
    Particles particles;
    particles.positions.resize(bytes.size() / sizeof(float));
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        particles.positions[i] = load<float>(bytes.data() + i * sizeof(float), std::endian::little);
    return particles;
}

float to_coordinate(double value, std::size_t particle, const ByteCursor& at) {
    constexpr auto limit = static_cast<double>(std::numeric_limits<float>::max());
    if (std::isfinite(value) && std::abs(value) > limit) {
        std::ostringstream message;
        message << "coordinate " << value << " of particle " << particle << " is beyond float32 (at most " << limit
                << ")";
        at.fail(message.str());
    }
    return static_cast<float>(value);
}

std::uint8_t to_level(double value, std::size_t particle, const ByteCursor& at) {
    if (!(value >= 0.0 && value <= double{max_particle_level}) || value != std::floor(value)) {
        std::ostringstream message;
        message << "level " << value << " of particle " << particle << " is not one of 0 to " << max_particle_level;
        at.fail(message.str());
    }
    return static_cast<std::uint8_t>(value);
}

}  // namespace meniscus::formats
