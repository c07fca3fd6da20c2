// Particle and mesh files to files of other formats.
#pragma once

#include <optional>
#include <string>

#include "cli/options/verbosity.hpp"
#include "cli/sequence/frame_selection.hpp"
#include "cli/sequence/share.hpp"
#include "formats/bytes/read_limits.hpp"
#include "formats/particles/particle_formats.hpp"

namespace meniscus::cli {

enum class FileContent { particles, mesh };

struct FileConversion {
    std::string in;                           ///< a file, "-", or a sequence with {}
    std::string out;                          ///< one file or a sequence, as `in`
    std::optional<std::string> input_format;  ///< name of a format of either; none: the extension's
    std::optional<std::string> format;        ///< of `out`, likewise
    std::optional<FileContent> content;       ///< none: what the file has, see content_of()
    bool without_levels = false;              ///< meshes are written without the levels of their triangles
    formats::ReadLimits limits;
    FrameSelection selection;
    std::optional<Share> share;  ///< of a sequence; none: all of it
    Verbosity verbosity;
};

/// The content of files of this format; none where it depends on the file: one with faces is a mesh. Throws
/// InvalidInput for a name of no format.
std::optional<FileContent> content_of(const std::string& format_name);

/// The format of a file of particles. Throws InvalidInput, naming those that are written, for any other.
formats::ParticleFormat written_particle_format(const std::string& name);

/// Throws InvalidInput, before any work, for names of files and formats that do not fit, and then for files that are
/// not what they are taken for.
void convert_files(const FileConversion& conversion);

}  // namespace meniscus::cli
