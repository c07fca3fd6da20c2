#include "formats/mesh_content.hpp"

#include <utility>

#include "formats/usda_writer.hpp"

namespace meniscus::formats {
namespace {

/// Whether the format is written from a Mesh as well.
bool is_from_mesh(MeshFormat format) {
    return format == MeshFormat::ply || format == MeshFormat::obj;
}

}  // namespace

MeshContent::MeshContent(Mesh ordered, MeshFormat format) : format_(format), ordered_(std::move(ordered)) {
    if (!is_from_mesh(format)) triangles();
}

TriangleMesh& MeshContent::triangles() {
    if (!triangles_) {
        triangles_ = to_triangles(ordered_);
        ordered_ = {};
    }
    return *triangles_;
}

void MeshContent::write(const std::filesystem::path& path, std::optional<double> time, bool compress) const {
    if (!triangles_) return format_ == MeshFormat::obj ? write_obj(path, ordered_) : write_ply(path, ordered_);
    if (format_ == MeshFormat::usda) return write_usda(path, *triangles_, time);
    write_mesh(path, *triangles_, format_, compress);
}

TriangleMesh MeshContent::form() const {
    TriangleMesh form;
    if (!triangles_) return form;
    form.wide = triangles_->wide;
    if (!triangles_->normals.empty()) form.normals.emplace_back();
    for (const NamedValues& values : triangles_->attributes)
        form.attributes.push_back({values.name, values.type, values.components, {}});
    return form;
}

}  // namespace meniscus::formats
