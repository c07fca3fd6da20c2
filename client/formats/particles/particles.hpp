// Particle files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/named_values.hpp"
#include "formats/read_limits.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

class ByteCursor;

/// One frame of particles, owned.
struct Particles {
    std::vector<float> positions;      ///< x y z per particle, world units; may hold NaN or infinity if the file does
    std::vector<std::uint8_t> levels;  ///< empty, or one per particle, 0 (finest) to max_particle_level
    /// What else the file tells of each particle, in its order, under array_name(): at most max_particle_arrays.
    std::vector<NamedValues> arrays{};
    /// A line for each array that the file has beside them, with the reason: "tensor (9 components)".
    std::vector<std::string> left_out{};

    /// Faces that the file has beside its points: it is a mesh, whose corners are taken as particles. 0 of particles.
    std::size_t faces = 0;
    /// What rounding took from `positions`: the file's coordinates are the sums, to 48 bits. Empty if it took nothing.
    std::vector<float> remainders{};

    std::size_t count() const { return positions.size() / 3; }
    /// As the file has it. index: into `positions`.
    double coordinate(std::size_t index) const {
        const auto rounded = static_cast<double>(positions[index]);
        return remainders.empty() ? rounded : rounded + static_cast<double>(remainders[index]);
    }
    /// Without arrays: their views have to lie somewhere, see views().
    ParticleFrame frame() const {
        ParticleFrame view;
        view.positions = positions;
        view.levels = levels;
        return view;
    }
};

/// The formats of particle files.
enum class ParticleFormat {
    vtk,  ///< legacy VTK
    ply,
    xyz,   ///< float32 triples, little-endian; also .bin and .raw
    vtu,   ///< VTK's XML, unstructured grid
    vtp,   ///< VTK's XML, polygonal data
    bgeo,  ///< Houdini's classic format, also gzipped, as Partio and SPlisHSPlasH write it
    npy,   ///< numpy, positions alone
    npz,   ///< numpy, zipped arrays
    hdf5,  ///< H5Part and PySPH; .h5, .hdf5, .h5part
    json,  ///< splashsurf's list of triples
    bi4,   ///< DualSPHysics
};
constexpr std::string_view name_of(ParticleFormat format) {
    switch (format) {
        case ParticleFormat::vtk:
            return "vtk";
        case ParticleFormat::ply:
            return "ply";
        case ParticleFormat::xyz:
            return "xyz";
        case ParticleFormat::vtu:
            return "vtu";
        case ParticleFormat::vtp:
            return "vtp";
        case ParticleFormat::bgeo:
            return "bgeo";
        case ParticleFormat::npy:
            return "npy";
        case ParticleFormat::npz:
            return "npz";
        case ParticleFormat::hdf5:
            return "hdf5";
        case ParticleFormat::json:
            return "json";
        case ParticleFormat::bi4:
            return "bi4";
    }
    return {};
}

/// The extensions of particle files that are read, with their dots; a name in lower case ends in one of them.
std::span<const std::string_view> particle_extensions();
/// The format that the extension names. Throws InvalidInput for any other extension.
ParticleFormat particle_format_of(const std::filesystem::path& path);

/// Reads a file, or standard input for "-". format: without it, the extension's. Throws InvalidInput, in one line that
/// names the file, for any other extension and for a file that is not of the format.
Particles read_particles(const std::filesystem::path& path, std::optional<ParticleFormat> format = std::nullopt,
                         const ReadLimits& limits = {});

/// Throws InvalidInput, telling which arrays the file has, unless these are among them. file: for messages.
void require_arrays(const std::string& file, const Particles& particles, std::span<const std::string> names);

/// The readers behind it. name: the file, for messages.
Particles read_vtk(const std::string& name, std::string_view bytes);
Particles read_particle_ply(const std::string& name, std::string_view bytes);
Particles read_xyz(const std::string& name, std::string_view bytes);
Particles read_vtk_xml(const std::string& name, std::string_view bytes, const ReadLimits& limits);
Particles read_bgeo(const std::string& name, std::string_view bytes, const ReadLimits& limits);
Particles read_npy(const std::string& name, std::string_view bytes);
Particles read_npz(const std::string& name, std::string_view bytes, const ReadLimits& limits);
Particles read_hdf5(const std::string& name, std::string_view bytes, const ReadLimits& limits);
Particles read_particle_json(const std::string& name, std::string_view bytes);
Particles read_bi4(const std::string& name, std::string_view bytes);

/// A name of a file as one of arrays: lower case, other characters than a-z, 0-9 and _ become _, at most 64.
std::string array_name(std::string_view name);

/// A coordinate as float32. Throws InvalidInput, naming the particle, if a finite value is beyond float32.
float to_coordinate(double value, std::size_t particle, const ByteCursor& at);
/// Sets a coordinate of `positions`, by its index there, which may be one beyond the last; and its remainder. Throws as
/// to_coordinate() does.
void set_coordinate(Particles& particles, std::size_t index, double value, const ByteCursor& at);
/// A particle level. Throws InvalidInput, naming the particle, unless it is 0 to max_particle_level.
std::uint8_t to_level(double value, std::size_t particle, const ByteCursor& at);

}  // namespace meniscus::formats
