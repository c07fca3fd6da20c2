// Particles as legacy VTK, which every tool for particles reads.
//
// By hand: the format is a header of a few lines before big-endian numbers, and VTK's own library takes hundreds of MB.
#pragma once

#include <filesystem>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// Writes float positions, an integer array `level` if the frame has levels, and its arrays: version 4.1, binary,
/// atomically. Throws InvalidInput if the path cannot be written.
void write_vtk(const std::filesystem::path& path, const ParticleFrame& frame);

}  // namespace meniscus::formats
