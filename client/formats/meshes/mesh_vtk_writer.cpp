#include <array>
#include <bit>
#include <limits>
#include <string>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/meshes/file_numbers.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "formats/vtk/legacy_vtk_arrays.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

void write_mesh_vtk(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& /*writing*/) {
    constexpr std::size_t most = std::size_t{std::numeric_limits<std::int32_t>::max()} / 5;
    const std::size_t face_count = mesh.triangles.size() + mesh.quads.size();
    if (face_count > most || mesh.positions.size() > most)
        throw InvalidInput(output_name(path) + ": legacy VTK holds at most " + std::to_string(most) +
                           " faces and vertices: write .vtp");
    const std::string points = std::to_string(mesh.positions.size());
    const std::string faces = std::to_string(face_count);
    AtomicFile file(path);
    file.write("# vtk DataFile Version 4.1\nMeniscus surface\nBINARY\nDATASET POLYDATA\nPOINTS " + points +
               (mesh.wide ? " double\n" : " float\n"));
    file.write(coordinate_bytes(mesh.positions, mesh.wide, std::endian::big));
    std::string out =
        "\nPOLYGONS " + faces + " " + std::to_string(4 * mesh.triangles.size() + 5 * mesh.quads.size()) + "\n";
    const auto store_face = [&](const auto& corners) {
        store(out, static_cast<std::uint32_t>(corners.size()), std::endian::big);
        for (const std::uint32_t corner : corners) store(out, corner, std::endian::big);
    };
    for (const Triangle& triangle : mesh.triangles) store_face(triangle);
    for (const Quad& quad : mesh.quads) store_face(quad);
    if (!mesh.levels.empty() || !mesh.quad_levels.empty()) {
        out += "\nCELL_DATA " + faces + "\nFIELD FieldData 1\nlevel 1 " + faces + " unsigned_char\n";
        out.append(mesh.levels.begin(), mesh.levels.end());
        out.append(mesh.quad_levels.begin(), mesh.quad_levels.end());
    }
    if (!mesh.normals.empty() || !mesh.attributes.empty()) out += "\nPOINT_DATA " + points + "\n";
    if (!mesh.normals.empty()) {
        out += "NORMALS Normals float\n";
        for (const Normal& normal : mesh.normals)
            for (const float x : normal) store(out, x, std::endian::big);
        out += '\n';
    }
    file.write(out);
    file.write(vtk_field(views(mesh.attributes), mesh.positions.size()));
    file.commit();
}

}  // namespace meniscus::formats
