// Surfaces to files.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cli/surfaces/mesh_edits.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "compare/closedness.hpp"
#include "formats/meshes/mesh_content.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::cli {

using formats::MeshFormat;

/// Throws InvalidInput unless the path's folder exists: to be called before long work.
void check_folder(const std::filesystem::path& path);
/// The format that is named, or that of the extension. Throws InvalidInput if there is neither, or no folder for the
/// file: to be called before long work.
MeshFormat check_mesh_path(const std::filesystem::path& path, std::optional<MeshFormat> named);
/// Throws InvalidInput unless `file` has an extension, or its format is named: "-" has none. option: that which names
/// it. formats: those that there are.
void check_named(const std::filesystem::path& file, bool named, const std::string& option,
                 std::span<const std::string_view> formats);
/// Checks the path of a file of points, which is PLY.
void check_points_path(const std::filesystem::path& path);
/// Throws InvalidInput unless these settings bring points for a file of spray: to be called before long work.
void check_spray(const Settings& settings);
/// A surface as it is written: in its canonical order, so that a file shows nothing of the way of its mesh.
class MeshOutput {
public:
    /// Does all that takes time but the writing. Takes the surface's mesh. check: the mesh is looked at.
    MeshOutput(Surface& surface, MeshFormat format, const MeshEdits& edits = {}, bool check = false);
    /// time: the time code of a USD file of a sequence.
    void write(const std::filesystem::path& path, std::optional<double> time = std::nullopt) const;
    /// The mesh's form, normals and attributes without values: for the stage of a sequence of USD files.
    formats::TriangleMesh form() const;
    /// None if it was not to be looked at.
    const std::optional<compare::Defects>& defects() const { return defects_; }

private:
    std::optional<formats::MeshContent> content_;
    std::optional<client::ReceivedFrame> bricks_;  ///< for a file of bricks
    std::optional<compare::Defects> defects_;
    bool compress_ = false;
};

/// Both at once.
void write_surface(const std::filesystem::path& path, Surface& surface, MeshFormat format);

/// "DIR/frame_000012.ply"
std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 std::string_view extension);

}  // namespace meniscus::cli
