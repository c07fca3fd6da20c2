#include <utility>

#include "formats/meshes/mesh_readers.hpp"
#include "formats/vtk/vtk_dataset.hpp"

namespace meniscus::formats {
namespace {

TriangleMesh to_triangle_mesh(VtkDataset dataset) {
    TriangleMesh mesh;
    mesh.positions = std::move(dataset.points);
    mesh.wide = dataset.wide;
    mesh.normals = std::move(dataset.normals);
    mesh.triangles = std::move(dataset.triangles);
    if (!dataset.cell_levels.empty()) {
        mesh.levels.reserve(mesh.triangles.size());
        for (const std::size_t cell : dataset.triangle_cells)
            mesh.levels.push_back(cell < dataset.cell_levels.size() ? dataset.cell_levels[cell] : std::uint8_t{0});
    }
    std::vector<std::string> left_out;
    dataset.arrays.finish(mesh.attributes, left_out);
    return mesh;
}

}  // namespace

TriangleMesh read_mesh_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    return to_triangle_mesh(read_legacy_vtk(name, bytes, limits, VtkUse::mesh));
}

TriangleMesh read_mesh_vtp(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    return to_triangle_mesh(read_xml_vtk(name, bytes, limits, VtkUse::mesh));
}

}  // namespace meniscus::formats
