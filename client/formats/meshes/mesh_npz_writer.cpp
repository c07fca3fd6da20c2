#include "formats/bytes/scalar.hpp"
#include "formats/containers/named_values.hpp"
#include "formats/containers/npz_writer.hpp"
#include "formats/meshes/file_numbers.hpp"
#include "formats/meshes/mesh_writers.hpp"

namespace meniscus::formats {

void write_mesh_npz(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& /*writing*/) {
    NpzWriter out(path);
    out.add("positions", mesh.wide ? "<f8" : "<f4", {mesh.positions.size(), 3},
            coordinate_bytes(mesh.positions, mesh.wide));
    out.add("triangles", "<u4", {mesh.triangles.size(), 3}, bytes_of(mesh.triangles.data(), mesh.triangles.size()));
    if (!mesh.normals.empty())
        out.add("normals", "<f4", {mesh.normals.size(), 3}, bytes_of(mesh.normals.data(), mesh.normals.size()));
    if (!mesh.levels.empty())
        out.add("levels", "|u1", {mesh.levels.size()}, bytes_of(mesh.levels.data(), mesh.levels.size()));
    for (const NamedValues& attribute : mesh.attributes) {
        const std::string name = name_beside({"positions", "triangles", "normals", "levels"}, attribute.name);
        out.add({name, attribute.data, attribute.type, attribute.components});
    }
    out.commit();
}

}  // namespace meniscus::formats
