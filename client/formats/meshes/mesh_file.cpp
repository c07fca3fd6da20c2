#include "formats/meshes/mesh_file.hpp"

#include <cmath>
#include <string>

#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {

TriangleMesh read_mesh(const std::filesystem::path& path, std::optional<MeshFormat> format, const ReadLimits& limits) {
    if (!format) format = mesh_format_of(path);
    const std::string bytes = read_input(path, limits.most_bytes);
    const std::string name = input_name(path);
    const MeshFormatRow& row = row_of(*format);
    if (row.read == nullptr)
        throw InvalidInput(name + ": " + std::string(row.name) + " is written, and not read; read are " +
                           listed(read_mesh_formats()));
    TriangleMesh mesh = row.read(name, bytes, limits);
    if (mesh.triangles.empty() && !mesh.positions.empty())
        throw InvalidInput(name + ": has no triangles, and " + std::to_string(mesh.positions.size()) +
                           (mesh.positions.size() == 1 ? " point" : " points") +
                           ": a mesh has triangles, and reconstruct makes one of particles");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (const double x : mesh.positions[i])
            if (!std::isfinite(x))
                throw InvalidInput(name + ": vertex " + std::to_string(i) + " has the coordinate " + std::to_string(x) +
                                   "; coordinates are finite");
    return mesh;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, MeshFormat format,
                const MeshWriting& writing) {
    const MeshFormatRow& row = row_of(format);
    if (row.write == nullptr)
        throw InvalidInput(output_name(path) + ": triangles are not written as " + std::string(row.name) +
                           ", which have the lattice of a reconstruction");
    row.write(path, mesh, writing);
}

}  // namespace meniscus::formats
