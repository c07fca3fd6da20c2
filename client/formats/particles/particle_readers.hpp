// Readers of particle files, one for each form of bytes. The formats that use them: particle_formats.hpp.
#pragma once

#include <string>
#include <string_view>

#include "formats/bytes/read_limits.hpp"
#include "formats/particles/particles.hpp"

namespace meniscus::formats {

/// name: the file, for messages. limits: for readers that decompress or that take memory beyond the bytes' own. Throw
/// InvalidInput, in one line that names the file, for bytes that are not of the format.
Particles read_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
Particles read_particle_ply(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// float32 triples, little-endian.
Particles read_xyz(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// VTK's XML, an unstructured grid or polygonal data.
Particles read_vtk_xml(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// Houdini's classic format, also gzipped, as Partio and SPlisHSPlasH write it.
Particles read_bgeo(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// numpy, positions alone.
Particles read_npy(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// numpy, zipped arrays.
Particles read_npz(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// H5Part and PySPH.
Particles read_hdf5(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// splashsurf's list of triples.
Particles read_particle_json(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// DualSPHysics.
Particles read_bi4(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});

}  // namespace meniscus::formats
