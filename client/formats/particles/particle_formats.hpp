// The formats of particle files, a row each. A new format is the file of its reader, of its writer, or both, its
// enumerator, and its row.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "formats/bytes/read_limits.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/particles/particle_writer.hpp"
#include "formats/particles/vtk_writer.hpp"
#include "meniscus/names.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// The formats in the order in which their names are listed.
enum class ParticleFormat { vtk, ply, xyz, vtu, vtp, bgeo, npy, npz, hdf5, json, bi4 };

struct ParticleFormatRow {
    ParticleFormat format;
    std::string_view name;
    std::array<std::string_view, 3> extensions;  ///< in lower case, with their dots; behind the last one empty
    Particles (*read)(const std::string& name, std::string_view bytes, const ReadLimits& limits);
    void (*write)(const std::filesystem::path& path, const ParticleFrame& frame);  ///< null: it is read only
};

/// The formats in the order in which their extensions are listed.
inline constexpr std::array particle_formats{
    ParticleFormatRow{ParticleFormat::vtk, "vtk", {".vtk"}, read_vtk, write_vtk},
    ParticleFormatRow{ParticleFormat::vtu, "vtu", {".vtu"}, read_vtk_xml, nullptr},
    ParticleFormatRow{ParticleFormat::vtp, "vtp", {".vtp"}, read_vtk_xml, write_particle_vtp},
    ParticleFormatRow{ParticleFormat::ply, "ply", {".ply"}, read_particle_ply, write_particle_ply},
    ParticleFormatRow{ParticleFormat::bgeo, "bgeo", {".bgeo", ".bgeo.gz"}, read_bgeo, nullptr},
    ParticleFormatRow{ParticleFormat::npy, "npy", {".npy"}, read_npy, nullptr},
    ParticleFormatRow{ParticleFormat::npz, "npz", {".npz"}, read_npz, write_particle_npz},
    ParticleFormatRow{ParticleFormat::hdf5, "hdf5", {".h5", ".hdf5", ".h5part"}, read_hdf5, nullptr},
    ParticleFormatRow{ParticleFormat::json, "json", {".json"}, read_particle_json, nullptr},
    ParticleFormatRow{ParticleFormat::bi4, "bi4", {".bi4"}, read_bi4, nullptr},
    ParticleFormatRow{ParticleFormat::xyz, "xyz", {".xyz", ".bin", ".raw"}, read_xyz, nullptr},
};

/// Null for a value that is no enumerator.
constexpr const ParticleFormatRow* row_of(ParticleFormat format) {
    for (const ParticleFormatRow& row : particle_formats)
        if (row.format == format) return &row;
    return nullptr;
}
constexpr std::string_view name_of(ParticleFormat format) {
    // By no pointer: to gcc 12's sanitizers a comparison of one with null is no constant.
    for (const ParticleFormatRow& row : particle_formats)
        if (row.format == format) return row.name;
    return {};
}
static_assert(choices<ParticleFormat>.size() == particle_formats.size(), "an enumerator without a row, or two rows");

/// The formats that particles are written in. PLY, which most programs read, comes first.
std::span<const ParticleFormat> written_particle_formats();
/// The extensions of particle files that are read, with their dots; a name in lower case ends in one of them.
std::span<const std::string_view> particle_extensions();
/// The format that the extension names. Throws InvalidInput for any other extension.
ParticleFormat particle_format_of(const std::filesystem::path& path);

}  // namespace meniscus::formats
