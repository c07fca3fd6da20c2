#include <limits>
#include <string>

#include "formats/file_numbers.hpp"
#include "formats/mesh_file.hpp"
#include "formats/vtp_writer.hpp"

namespace meniscus::formats {
namespace {

template <class Number>
std::string cell_ends(std::size_t cells, std::size_t corners) {
    std::string out;
    out.reserve(cells * sizeof(Number));
    for (std::size_t i = 1; i <= cells; ++i) store(out, static_cast<Number>(corners * i));
    return out;
}

void add_polygons(VtpWriter& out, const TriangleMesh& mesh) {
    const std::size_t corners = 3 * mesh.triangles.size();
    // Up to 2^31 - 1 as VTK's Int32, which is what lies in memory.
    if (corners <= std::size_t{std::numeric_limits<std::int32_t>::max()} &&
        mesh.positions.size() <= std::size_t{std::numeric_limits<std::int32_t>::max()}) {
        out.add("connectivity", "Int32", 1, bytes_of(mesh.triangles.data(), mesh.triangles.size()));
        return out.add("offsets", "Int32", 1, cell_ends<std::int32_t>(mesh.triangles.size(), 3));
    }
    std::string connectivity;
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) store(connectivity, std::int64_t{corner});
    out.add("connectivity", "Int64", 1, connectivity);
    out.add("offsets", "Int64", 1, cell_ends<std::int64_t>(mesh.triangles.size(), 3));
}

}  // namespace

void write_mesh_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, VtpCompression compression) {
    VtpWriter out(compression);
    out.begin("PointData", mesh.normals.empty() ? "" : " Normals=\"Normals\"");
    if (!mesh.normals.empty()) out.add("Normals", "Float32", 3, bytes_of(mesh.normals.data(), mesh.normals.size()));
    for (const NamedValues& attribute : mesh.attributes) out.add(attribute.view());
    out.end("PointData");
    out.begin("CellData");
    if (!mesh.levels.empty()) out.add("level", "UInt8", 1, bytes_of(mesh.levels.data(), mesh.levels.size()));
    out.end("CellData");
    out.begin("Points");
    out.add("Points", mesh.wide ? "Float64" : "Float32", 3, coordinate_bytes(mesh.positions, mesh.wide));
    out.end("Points");
    out.begin("Polys");
    add_polygons(out, mesh);
    out.end("Polys");
    out.write(path, mesh.positions.size(), 0, mesh.triangles.size());
}

}  // namespace meniscus::formats
