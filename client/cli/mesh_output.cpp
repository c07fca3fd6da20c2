#include "cli/mesh_output.hpp"

#include <string>
#include <string_view>

#include "cli/file_pattern.hpp"
#include "cli/mesh_check.hpp"
#include "editing/mesh_box.hpp"
#include "editing/quads.hpp"
#include "formats/brick_file.hpp"
#include "formats/extension.hpp"
#include "formats/mesh_file.hpp"
#include "formats/standard_streams.hpp"
#include "formats/usda_writer.hpp"
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

MeshOutput::MeshOutput(const Surface& surface, MeshFormat format, const MeshEdits& edits, bool check)
    : format_(format) {
    if (format == MeshFormat::bricks) bricks_ = surface.encoded();
    if (format == MeshFormat::bricks && !check) return;
    ordered_ = in_canonical_order(surface.mesh());
    const bool from_mesh = format == MeshFormat::ply || format == MeshFormat::obj || format == MeshFormat::bricks;
    if (from_mesh && !check && !edits.any()) return;
    triangles_ = formats::to_triangles(ordered_);
    if (edits.origin) editing::move_from(*triangles_, *edits.origin);
    if (edits.box) editing::keep_touching(*triangles_, *edits.box);
    if (check) defects_ = defects_of(*triangles_);
    if (edits.quads) editing::merge_to_quads(*triangles_);
    if (from_mesh && !edits.any()) triangles_.reset();
}

void MeshOutput::write(const std::filesystem::path& path, std::optional<double> time) const {
    if (triangles_ && format_ == MeshFormat::usda) return formats::write_usda(path, *triangles_, time);
    if (bricks_) return formats::write_bricks(path, *bricks_);
    if (triangles_) return formats::write_mesh(path, *triangles_, format_);
    if (format_ == MeshFormat::obj) return formats::write_obj(path, ordered_);
    formats::write_ply(path, ordered_);
}

formats::TriangleMesh MeshOutput::form() const {
    formats::TriangleMesh form;
    if (!triangles_) return form;
    form.wide = triangles_->wide;
    if (!triangles_->normals.empty()) form.normals.emplace_back();
    for (const formats::NamedValues& values : triangles_->attributes)
        form.attributes.push_back({values.name, values.type, values.components, {}});
    return form;
}

void write_surface(const std::filesystem::path& path, const Surface& surface, MeshFormat format) {
    MeshOutput(surface, format).write(path);
}

std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 std::string_view extension) {
    return FilePattern((directory / ("frame_{:06}." + std::string(extension))).string()).at(index);
}

}  // namespace meniscus::cli
