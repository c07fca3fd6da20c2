#include "editing/mesh_box.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace meniscus::editing {
namespace {

bool contains(const Box& box, const std::array<double, 3>& x) {
    for (std::size_t a = 0; a < 3; ++a)
        if (!(x[a] >= box.min[a] && x[a] <= box.max[a])) return false;
    return true;
}

void keep_triangles(formats::TriangleMesh& mesh, const std::vector<bool>& inside) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        if (!inside[t[0]] && !inside[t[1]] && !inside[t[2]]) continue;
        mesh.triangles[kept] = t;
        if (!mesh.levels.empty()) mesh.levels[kept] = mesh.levels[i];
        ++kept;
    }
    mesh.triangles.resize(kept);
    if (!mesh.levels.empty()) mesh.levels.resize(kept);
}

void drop_unused_vertices(formats::TriangleMesh& mesh) {
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> places(mesh.positions.size(), unused);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) places[v] = 0;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (places[v] == unused) continue;
        places[v] = kept;
        mesh.positions[kept] = mesh.positions[v];
        if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
        for (formats::NamedValues& attribute : mesh.attributes)
            std::memmove(attribute.data.data() + kept * attribute.element_bytes(),
                         attribute.data.data() + v * attribute.element_bytes(), attribute.element_bytes());
        ++kept;
    }
    mesh.positions.resize(kept);
    if (!mesh.normals.empty()) mesh.normals.resize(kept);
    for (formats::NamedValues& attribute : mesh.attributes) attribute.data.resize(kept * attribute.element_bytes());
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& v : t) v = places[v];
}

}  // namespace

void keep_touching(formats::TriangleMesh& mesh, const Box& box) {
    std::vector<bool> inside(mesh.positions.size());
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = contains(box, mesh.positions[v]);
    keep_triangles(mesh, inside);
    drop_unused_vertices(mesh);
}

}  // namespace meniscus::editing
