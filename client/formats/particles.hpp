// Particle files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

class ByteCursor;

/// One frame of particles, owned.
struct Particles {
    std::vector<float> positions;      ///< x y z per particle, world units; may hold NaN or infinity if the file does
    std::vector<std::uint8_t> levels;  ///< empty, or one per particle, 0 (finest) to max_particle_level

    /// Faces that the file has beside its points: it is a mesh, whose corners are taken as particles. 0 of particles.
    std::size_t faces = 0;

    std::size_t count() const { return positions.size() / 3; }
    ParticleFrame frame() const {
        ParticleFrame view;
        view.positions = positions;
        view.levels = levels;
        return view;
    }
};

/// Reads particles by the file's extension: .vtk (legacy VTK), .ply, or .xyz, .bin, .raw (float32 triples,
/// little-endian). Throws InvalidInput, in one line that names the file, for any other extension and for a file that is
/// not of the format that its extension names.
Particles read_particles(const std::filesystem::path& path);

/// The readers behind it. name: the file, for messages.
Particles read_vtk(const std::string& name, std::string_view bytes);
Particles read_particle_ply(const std::string& name, std::string_view bytes);
Particles read_xyz(const std::string& name, std::string_view bytes);

/// A coordinate as float32. Throws InvalidInput, naming the particle, if a finite value is beyond float32.
float to_coordinate(double value, std::size_t particle, const ByteCursor& at);
/// A particle level. Throws InvalidInput, naming the particle, unless it is 0 to max_particle_level.
std::uint8_t to_level(double value, std::size_t particle, const ByteCursor& at);

}  // namespace meniscus::formats
