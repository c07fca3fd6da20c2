#include "formats/meshes/mesh_content.hpp"

#include <utility>

namespace meniscus::formats {
MeshContent::MeshContent(Mesh ordered, MeshFormat format) : format_(format), ordered_(std::move(ordered)) {
    if (row_of(format).write_reconstructed == nullptr) triangles();
}

TriangleMesh& MeshContent::triangles() {
    if (!triangles_) {
        triangles_ = to_triangles(ordered_);
        ordered_ = {};
    }
    return *triangles_;
}

void MeshContent::write(const std::filesystem::path& path, const MeshWriting& writing) const {
    if (!triangles_) return row_of(format_).write_reconstructed(path, ordered_);
    write_mesh(path, *triangles_, format_, writing);
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
