// A mesh as GLB: positions are float32 around the middle of the mesh; a node puts them in place, by float64.
#include "formats/meshes/glb_writer.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "files/centered_positions.hpp"
#include "files/glb_document.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/meshes/glb_draco.hpp"

namespace meniscus::formats {
namespace {

using files::GlbVertices;

std::vector<GlbVertices> all_vertices(const TriangleMesh& mesh, const std::vector<std::array<float, 3>>& positions) {
    std::vector<GlbVertices> all;
    all.push_back(files::glb_positions(positions));
    // The positions of a mesh are finite; what else a file of strangers has need not be.
    const auto add = [&](GlbVertices vertices) {
        if (files::is_finite(vertices)) all.push_back(std::move(vertices));
    };
    if (mesh.normals.size() == positions.size()) add(files::glb_normals(mesh.normals));
    for (const NamedValues& values : mesh.attributes)
        add(files::glb_attribute(values.name, values.type, values.components, values.data));
    return all;
}

files::GlbBounds bounds_of(const std::vector<std::array<float, 3>>& positions) {
    files::GlbBounds bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax_element(
            positions.begin(), positions.end(), [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        bounds.low[axis] = (*low)[axis];
        bounds.high[axis] = (*high)[axis];
    }
    return bounds;
}

}  // namespace

std::string to_glb(const TriangleMesh& mesh, GlbCoding coding) {
    const files::CenteredPositions centered(mesh.positions);
    files::GlbDocument document({.translation = centered.middle});
    if (!mesh.triangles.empty()) {
        const std::vector<GlbVertices> all = all_vertices(mesh, centered.positions);
        if (coding == GlbCoding::draco)
            add_draco(all, bounds_of(centered.positions), mesh.triangles, document);
        else
            document.add(all, mesh.triangles);
    }
    return std::move(document).file();
}

void write_glb(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing) {
    write_file(path, to_glb(mesh, writing.compress ? GlbCoding::draco : GlbCoding::plain));
}

}  // namespace meniscus::formats
