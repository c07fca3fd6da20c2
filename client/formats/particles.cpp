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
    if (extension == ".vtu") return ParticleFormat::vtu;
    if (extension == ".vtp") return ParticleFormat::vtp;
    if (extension == ".bgeo" || path.string().ends_with(".bgeo.gz")) return ParticleFormat::bgeo;
    if (extension == ".npy") return ParticleFormat::npy;
    if (extension == ".npz") return ParticleFormat::npz;
    if (extension == ".h5" || extension == ".hdf5" || extension == ".h5part") return ParticleFormat::hdf5;
    if (extension == ".json") return ParticleFormat::json;
    if (extension == ".bi4") return ParticleFormat::bi4;
    throw InvalidInput(
        path.string() +
        ": particle files end in .vtk, .vtu, .vtp, .ply, .bgeo, .npy, .npz, .h5, .hdf5, .h5part, .json, .bi4, "
        ".xyz, .bin or .raw, not in '" +
        extension + "'");
}

Particles read_particles(const std::filesystem::path& path, std::optional<ParticleFormat> format,
                         const ReadLimits& limits) {
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
        case ParticleFormat::vtu:
        case ParticleFormat::vtp:
            return read_vtk_xml(name, bytes, limits);
        case ParticleFormat::bgeo:
            return read_bgeo(name, bytes, limits);
        case ParticleFormat::npy:
            return read_npy(name, bytes);
        case ParticleFormat::npz:
            return read_npz(name, bytes, limits);
        case ParticleFormat::hdf5:
            return read_hdf5(name, bytes, limits);
        case ParticleFormat::json:
            return read_particle_json(name, bytes);
        case ParticleFormat::bi4:
            return read_bi4(name, bytes);
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

std::string array_name(std::string_view name) {
    std::string out;
    for (const char c : name.substr(0, 64)) {
        if (c >= 'A' && c <= 'Z')
            out += static_cast<char>(c - 'A' + 'a');
        else
            out += (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : '_';
    }
    return out.empty() ? "_" : out;
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
