#include "cli/surfaces/mesh_output.hpp"

#include <string>
#include <string_view>
#include <utility>

#include "cli/sequence/file_pattern.hpp"
#include "cli/surfaces/mesh_check.hpp"
#include "editing/mesh_box.hpp"
#include "editing/quads.hpp"
#include "formats/bytes/extension.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/canonical_order.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {

void check_folder(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw InvalidInput(path.string() + ": cannot be written: there is no folder " + folder.string());
}

MeshFormat check_mesh_path(const std::filesystem::path& path, std::optional<MeshFormat> named) {
    check_named(path, named.has_value(), "--format", names<MeshFormat>);
    const MeshFormat format = named ? *named : formats::mesh_format_of(path);
    check_folder(path);
    return format;
}

void check_named(const std::filesystem::path& file, bool named, const std::string& option,
                 std::span<const std::string_view> formats) {
    if (formats::is_standard_stream(file) && !named)
        throw InvalidInput("'-' has no extension: name its format by " + option + ": " + listed(formats));
}

void check_points_path(const std::filesystem::path& path) {
    if (!formats::is_standard_stream(path) && formats::lower_extension(path) != ".ply")
        throw InvalidInput(path.string() + ": points are written as .ply, not as '" + formats::lower_extension(path) +
                           "'");
    check_folder(path);
}

void check_spray(const Settings& settings) {
    if (settings.spray != Spray::points)
        throw InvalidInput("--spray-out has nothing to write: spray is '" + std::string(name_of(settings.spray)) +
                           "', and must be '" + std::string(name_of(Spray::points)) + "'");
}

MeshOutput::MeshOutput(Surface& surface, MeshFormat format, const MeshEdits& edits, bool check)
    : compress_(edits.compress) {
    if (format == MeshFormat::bricks) bricks_ = surface.encoded();
    if (format == MeshFormat::bricks && !check) return;
    Mesh mesh = surface.take_mesh();
    put_in_canonical_order(mesh);
    content_.emplace(std::move(mesh), format);
    if (!check && !edits.any()) return;
    formats::TriangleMesh& triangles = content_->triangles();
    if (edits.origin) editing::move_from(triangles, *edits.origin);
    if (edits.box) editing::keep_touching(triangles, *edits.box);
    if (check) defects_ = defects_of(triangles);
    if (edits.quads) editing::merge_to_quads(triangles);
    if (edits.without_levels) formats::leave_out_levels(triangles);
}

void MeshOutput::write(const std::filesystem::path& path, std::optional<double> time) const {
    if (bricks_) return formats::write_bricks(path, *bricks_);
    content_->write(path, {.compress = compress_, .time = time});
}

formats::TriangleMesh MeshOutput::form() const {
    return content_ ? content_->form() : formats::TriangleMesh{};
}

void write_surface(const std::filesystem::path& path, Surface& surface, MeshFormat format) {
    MeshOutput(surface, format).write(path);
}

std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 std::string_view extension) {
    return FilePattern((directory / ("frame_{:06}." + std::string(extension))).string()).at(index);
}

}  // namespace meniscus::cli
