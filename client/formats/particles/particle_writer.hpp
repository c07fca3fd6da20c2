// Particles to files.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "formats/particles.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// The formats that particles are written in.
inline constexpr std::array written_particle_formats{ParticleFormat::ply, ParticleFormat::vtk, ParticleFormat::vtp,
                                                     ParticleFormat::npz};

/// Writes positions, the array `level` (in .npz `levels`) if there are levels, and all arrays, atomically. Throws
/// InvalidInput if the path cannot be written, and for formats that are not written, naming those that are.
void write_particles(const std::filesystem::path& path, const Particles& particles, ParticleFormat format);
void write_particles(const std::filesystem::path& path, const ParticleFrame& frame, ParticleFormat format);

/// The writers behind it, beside write_vtk(). The frame's positions are not quantized.
///
/// Binary PLY with vertices alone; the names of properties as write_ply() of a mesh chooses them.
void write_particle_ply(const std::filesystem::path& path, const ParticleFrame& frame);
/// VTK's XML, polygonal data with a vertex for each particle.
void write_particle_vtp(const std::filesystem::path& path, const ParticleFrame& frame);
/// Arrays positions (N, 3), levels, and the others by their names.
void write_particle_npz(const std::filesystem::path& path, const ParticleFrame& frame);

}  // namespace meniscus::formats
