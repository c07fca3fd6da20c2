#include <limits>
#include <string>
#include <vector>

#include "formats/bytes/scalar.hpp"
#include "formats/meshes/file_numbers.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "formats/vtk/vtk_dataset.hpp"
#include "formats/vtk/vtk_xml_writer.hpp"

namespace meniscus::formats {
namespace {

/// Where each face's corners end in the list of all: those of the triangles, then of the quadrilaterals.
template <class Number>
std::string face_ends(const TriangleMesh& mesh) {
    std::string out;
    out.reserve((mesh.triangles.size() + mesh.quads.size()) * sizeof(Number));
    for (std::size_t i = 1; i <= mesh.triangles.size(); ++i) store(out, static_cast<Number>(3 * i));
    for (std::size_t i = 1; i <= mesh.quads.size(); ++i)
        store(out, static_cast<Number>(3 * mesh.triangles.size() + 4 * i));
    return out;
}

std::vector<std::uint8_t> face_levels(const TriangleMesh& mesh) {
    std::vector<std::uint8_t> levels = mesh.levels;
    levels.insert(levels.end(), mesh.quad_levels.begin(), mesh.quad_levels.end());
    return levels;
}

void add_faces(VtkXmlWriter& out, const TriangleMesh& mesh) {
    const std::size_t corners = 3 * mesh.triangles.size() + 4 * mesh.quads.size();
    // Up to 2^31 - 1 as VTK's Int32, which is what lies in memory.
    if (corners <= std::size_t{std::numeric_limits<std::int32_t>::max()} &&
        mesh.positions.size() <= std::size_t{std::numeric_limits<std::int32_t>::max()}) {
        std::string connectivity(bytes_of(mesh.triangles.data(), mesh.triangles.size()));
        connectivity += bytes_of(mesh.quads.data(), mesh.quads.size());
        out.add("connectivity", "Int32", 1, connectivity);
        return out.add("offsets", "Int32", 1, face_ends<std::int32_t>(mesh));
    }
    std::string connectivity;
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) store(connectivity, std::int64_t{corner});
    for (const Quad& quad : mesh.quads)
        for (const std::uint32_t corner : quad) store(connectivity, std::int64_t{corner});
    out.add("connectivity", "Int64", 1, connectivity);
    out.add("offsets", "Int64", 1, face_ends<std::int64_t>(mesh));
}

std::string face_types(const TriangleMesh& mesh) {
    std::string types(mesh.triangles.size(), static_cast<char>(VtkCell::triangle));
    return types.append(mesh.quads.size(), static_cast<char>(VtkCell::quad));
}

void write_mesh_vtk_xml(const std::filesystem::path& path, VtkXmlKind kind, const TriangleMesh& mesh,
                        const MeshWriting& writing) {
    const VtkXmlCompression compression = writing.compress ? VtkXmlCompression::zlib : VtkXmlCompression::none;
    VtkXmlWriter out(path, kind, {.points = mesh.positions.size(), .polys = mesh.triangles.size() + mesh.quads.size()},
                     compression);
    out.begin("PointData", mesh.normals.empty() ? "" : " Normals=\"Normals\"");
    if (!mesh.normals.empty()) out.add("Normals", "Float32", 3, bytes_of(mesh.normals.data(), mesh.normals.size()));
    for (const NamedValues& attribute : mesh.attributes) out.add(attribute.view());
    out.end("PointData");
    out.begin("CellData");
    const std::vector<std::uint8_t> levels = face_levels(mesh);
    if (!levels.empty()) out.add("level", "UInt8", 1, bytes_of(levels.data(), levels.size()));
    out.end("CellData");
    out.begin("Points");
    out.add("Points", mesh.wide ? "Float64" : "Float32", 3, coordinate_bytes(mesh.positions, mesh.wide));
    out.end("Points");
    const std::string_view cells = kind == VtkXmlKind::poly_data ? "Polys" : "Cells";
    out.begin(cells);
    add_faces(out, mesh);
    if (kind == VtkXmlKind::unstructured_grid) out.add("types", "UInt8", 1, face_types(mesh));
    out.end(cells);
    out.commit();
}

}  // namespace

void write_mesh_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing) {
    write_mesh_vtk_xml(path, VtkXmlKind::poly_data, mesh, writing);
}

void write_mesh_vtu(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing) {
    write_mesh_vtk_xml(path, VtkXmlKind::unstructured_grid, mesh, writing);
}

}  // namespace meniscus::formats
