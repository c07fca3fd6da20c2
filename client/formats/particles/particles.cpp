#include "formats/particles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "formats/array_collector.hpp"
#include "formats/byte_cursor.hpp"
#include "formats/extension.hpp"
#include "formats/scalar.hpp"
#include "formats/standard_streams.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {

namespace {

struct Extension {
    std::string_view ending;
    ParticleFormat format;
};

constexpr std::array extensions{
    Extension{".vtk", ParticleFormat::vtk},     Extension{".vtu", ParticleFormat::vtu},
    Extension{".vtp", ParticleFormat::vtp},     Extension{".ply", ParticleFormat::ply},
    Extension{".bgeo", ParticleFormat::bgeo},   Extension{".bgeo.gz", ParticleFormat::bgeo},
    Extension{".npy", ParticleFormat::npy},     Extension{".npz", ParticleFormat::npz},
    Extension{".h5", ParticleFormat::hdf5},     Extension{".hdf5", ParticleFormat::hdf5},
    Extension{".h5part", ParticleFormat::hdf5}, Extension{".json", ParticleFormat::json},
    Extension{".bi4", ParticleFormat::bi4},     Extension{".xyz", ParticleFormat::xyz},
    Extension{".bin", ParticleFormat::xyz},     Extension{".raw", ParticleFormat::xyz},
};

constexpr auto endings = [] {
    std::array<std::string_view, extensions.size()> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = extensions[i].ending;
    return all;
}();

}  // namespace

std::span<const std::string_view> particle_extensions() {
    return endings;
}

ParticleFormat particle_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    const std::string zipped = extension == ".gz" ? lower_extension(path.stem()) + extension : extension;
    for (const Extension& known : extensions)
        if (known.ending == zipped) return known.format;
    throw InvalidInput(path.string() + ": particle files end in " + listed(endings) + ", not in '" + extension + "'");
}

void require_arrays(const std::string& file, const Particles& particles, std::span<const std::string> names) {
    for (const std::string& name : names)
        if (std::none_of(particles.arrays.begin(), particles.arrays.end(),
                         [&](const NamedValues& array) { return array.name == name; }))
            throw InvalidInput(file + ": no array " + quote(name) + "; the file " +
                               described(particles.arrays, particles.left_out));
}

Particles read_particles(const std::filesystem::path& path, std::optional<ParticleFormat> format,
                         const ReadLimits& limits) {
    if (!format) format = particle_format_of(path);
    const std::string bytes = read_input(path, limits.most_bytes);
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
