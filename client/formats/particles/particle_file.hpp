// Particle files, of any format.
#pragma once

#include <filesystem>
#include <optional>

#include "formats/bytes/read_limits.hpp"
#include "formats/particles/particle_formats.hpp"
#include "formats/particles/particles.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// Reads a file, or standard input for "-". format: without it, the extension's. Throws InvalidInput, in one line that
/// names the file, for any other extension and for a file that is not of the format.
Particles read_particles(const std::filesystem::path& path, std::optional<ParticleFormat> format = std::nullopt,
                         const ReadLimits& limits = {});

/// Writes positions, the array `level` (in .npz `levels`) if there are levels, and all arrays, atomically. Throws
/// InvalidInput if the path cannot be written, and for formats that are not written, naming those that are.
void write_particles(const std::filesystem::path& path, const Particles& particles, ParticleFormat format);
void write_particles(const std::filesystem::path& path, const ParticleFrame& frame, ParticleFormat format);

}  // namespace meniscus::formats
