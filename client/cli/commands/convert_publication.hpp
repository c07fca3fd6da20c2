// Frames of a publication as mesh files.
#pragma once

#include <filesystem>

#include "cli/sequence/frame_meshes.hpp"
#include "cli/surfaces/mesh_edits.hpp"
#include "formats/meshes/mesh_formats.hpp"

namespace meniscus::cli {

struct PublicationConversion {
    std::filesystem::path publication;
    std::filesystem::path out;  ///< a folder, or - for one frame
    FrameRange range;
    formats::MeshFormat format = formats::MeshFormat::ply;
    MeshEdits edits{};
    bool quiet = false;
};

/// Throws InvalidInput, too, for two frames of one index, which are of several runs.
void convert_publication(const PublicationConversion& conversion);

}  // namespace meniscus::cli
