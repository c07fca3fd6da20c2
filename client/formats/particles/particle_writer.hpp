// Writers of particle files, beside vtk_writer.hpp. The formats that use them: particle_formats.hpp.
#pragma once

#include <filesystem>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// Write atomically, and throw InvalidInput if the path cannot be written. The frame's positions are not quantized.
///
/// Binary PLY with vertices alone; the names of properties as write_ply() of a mesh chooses them.
void write_particle_ply(const std::filesystem::path& path, const ParticleFrame& frame);
/// VTK's XML, polygonal data with a vertex for each particle.
void write_particle_vtp(const std::filesystem::path& path, const ParticleFrame& frame);
/// Arrays positions (N, 3), levels, and the others by their names.
void write_particle_npz(const std::filesystem::path& path, const ParticleFrame& frame);

}  // namespace meniscus::formats
