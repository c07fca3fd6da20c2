#include "formats/meshes/triangle_mesh.hpp"

#include <algorithm>
#include <cstdlib>

namespace meniscus::formats {

bool needs_double(const Mesh& mesh) {
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [](const LatticePosition& p) {
        return std::any_of(p.begin(), p.end(), [](std::int32_t x) {
            return needs_double(static_cast<std::uint64_t>(std::abs(std::int64_t{x})));
        });
    });
}

TriangleMesh to_triangles(const Mesh& mesh) {
    TriangleMesh out;
    out.positions.reserve(mesh.vertices.size());
    for (const LatticePosition& p : mesh.vertices) out.positions.push_back(mesh.world(p));
    out.normals.assign(mesh.normals.begin(), mesh.normals.end());
    out.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    out.levels.resize(mesh.triangles.size());
    for (std::size_t i = 0; i < out.levels.size(); ++i) out.levels[i] = level_byte(mesh.level_of(i));
    for (const MeshAttribute& a : mesh.attributes)
        out.attributes.push_back({a.name, a.type, a.components, {a.data.begin(), a.data.end()}});
    out.wide = needs_double(mesh);
    return out;
}

void leave_out_levels(TriangleMesh& mesh) {
    mesh.levels.clear();
    mesh.quad_levels.clear();
}

}  // namespace meniscus::formats
