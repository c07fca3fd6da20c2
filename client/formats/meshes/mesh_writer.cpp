#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string>
#include <vector>

#include "formats/bytes/atomic_file.hpp"
#include "formats/containers/ply_properties.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "meniscus/number_text.hpp"

namespace meniscus::formats {
namespace {

constexpr std::size_t flush_bytes = std::size_t{1} << 20;

/// Numbers of a binary file, as they lie in memory.
template <class Numbers>
void append_bytes(std::string& out, const Numbers& numbers) {
    static_assert(std::endian::native == std::endian::little, "the files are little-endian");
    out.append(reinterpret_cast<const char*>(&numbers), sizeof numbers);
}

void flush(AtomicFile& file, std::string& buffer, std::size_t above) {
    if (buffer.size() < above) return;
    file.write(buffer);
    buffer.clear();
}

/// Faces that lie together and are of one level.
struct Run {
    std::size_t first = 0;
    std::size_t end = 0;
    std::uint8_t level = 0;
};

/// The runs of `count` faces of one level. levels: empty, or one per face.
std::vector<Run> runs_of(const std::vector<std::uint8_t>& levels, std::size_t count) {
    std::vector<Run> runs;
    if (levels.empty() && count > 0) runs.push_back({0, count, 0});
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (runs.empty() || runs.back().level != levels[i]) runs.push_back({i, i, levels[i]});
        ++runs.back().end;
    }
    return runs;
}

/// A mesh as the writers see it.
struct MeshView {
    bool wide = false;
    std::span<const Normal> normals;  ///< empty, or one per vertex
    std::span<const Triangle> triangles;
    bool levels = false;  ///< runs have levels
    std::vector<Run> runs;
    std::span<const Quad> quads;
    std::vector<Run> quad_runs;
    std::vector<ParticleArray> attributes;
};

MeshView view_of(const Mesh& mesh) {
    MeshView out;
    out.wide = needs_double(mesh);
    if (mesh.normals.size() == mesh.vertices.size()) out.normals = mesh.normals;
    out.triangles = mesh.triangles;
    out.levels = true;
    for (const TriangleLevel level : choices<TriangleLevel>) {
        const TriangleRange range = mesh.levels[static_cast<std::size_t>(level)];
        if (range.count > 0)
            out.runs.push_back({range.first, std::size_t{range.first} + range.count, level_byte(level)});
    }
    for (const MeshAttribute& a : mesh.attributes) out.attributes.push_back({a.name, a.data, a.type, a.components});
    return out;
}

MeshView view_of(const TriangleMesh& mesh) {
    MeshView out;
    out.wide = mesh.wide;
    if (mesh.normals.size() == mesh.positions.size()) out.normals = mesh.normals;
    out.triangles = mesh.triangles;
    out.levels = !mesh.levels.empty() || !mesh.quad_levels.empty();
    out.runs = runs_of(mesh.levels, mesh.triangles.size());
    out.quads = mesh.quads;
    out.quad_runs = runs_of(mesh.quad_levels, mesh.quads.size());
    out.attributes = views(mesh.attributes);
    return out;
}

std::size_t vertex_count(const Mesh& mesh) {
    return mesh.vertices.size();
}
std::size_t vertex_count(const TriangleMesh& mesh) {
    return mesh.positions.size();
}
std::array<double, 3> place_of(const Mesh& mesh, std::size_t vertex) {
    return mesh.world(mesh.vertices[vertex]);
}
const std::array<double, 3>& place_of(const TriangleMesh& mesh, std::size_t vertex) {
    return mesh.positions[vertex];
}

template <class AnyMesh>
void write_ply_of(const std::filesystem::path& path, const AnyMesh& mesh) {
    const MeshView view = view_of(mesh);
    const std::size_t vertices = vertex_count(mesh);
    const std::string type = view.wide ? "double " : "float ";
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    if (view.levels) out += "comment Meniscus: face level 1, 2, 3; crack filling 0\n";
    out += "element vertex " + std::to_string(vertices) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += "property " + type + axis + "\n";
    if (!view.normals.empty()) out += "property float nx\nproperty float ny\nproperty float nz\n";
    out += ply_properties(view.attributes);
    out += "element face " + std::to_string(view.triangles.size()) + "\n";
    out += "property list uchar uint vertex_indices\n";
    if (view.levels) out += "property uchar level\n";
    out += "end_header\n";
    AtomicFile file(path);
    for (std::size_t i = 0; i < vertices; ++i) {
        const std::array<double, 3>& place = place_of(mesh, i);
        if (view.wide)
            append_bytes(out, place);
        else
            append_bytes(out, std::array{static_cast<float>(place[0]), static_cast<float>(place[1]),
                                         static_cast<float>(place[2])});
        if (!view.normals.empty()) append_bytes(out, view.normals[i]);
        for (const ParticleArray& array : view.attributes) append_element(out, array, i);
        flush(file, out, flush_bytes);
    }
    for (const Run& run : view.runs)
        for (std::size_t i = run.first; i < run.end; ++i) {
            out += char{3};
            append_bytes(out, view.triangles[i]);
            if (view.levels) out += static_cast<char>(run.level);
            flush(file, out, flush_bytes);
        }
    flush(file, out, 0);
    file.commit();
}

/// The group of OBJ for a level's byte.
std::string_view group_name(std::uint8_t level) {
    for (const TriangleLevel choice : choices<TriangleLevel>)
        if (level_byte(choice) == level) return name_of(choice);
    return name_of(TriangleLevel::crack);
}

template <class AnyMesh>
void write_obj_of(const std::filesystem::path& path, const AnyMesh& mesh) {
    const MeshView view = view_of(mesh);
    const std::size_t vertices = vertex_count(mesh);
    std::string out = "# Meniscus\n";
    AtomicFile file(path);
    for (std::size_t i = 0; i < vertices; ++i) {
        out += 'v';
        for (const double x : place_of(mesh, i)) {
            out += ' ';
            if (view.wide)
                append_shortest(out, x);
            else
                append_shortest(out, static_cast<float>(x));
        }
        out += '\n';
        flush(file, out, flush_bytes);
    }
    for (const Normal& normal : view.normals) {
        out += "vn";
        for (const float x : normal) append_shortest(out += ' ', x);
        out += '\n';
        flush(file, out, flush_bytes);
    }
    const auto write_faces = [&](const auto& faces, const std::vector<Run>& runs) {
        for (const Run& run : runs) {
            if (view.levels) out.append("g ").append(group_name(run.level)).append("\n");
            for (std::size_t i = run.first; i < run.end; ++i) {
                out += 'f';
                for (const std::uint32_t v : faces[i]) {
                    append_shortest(out += ' ', std::uint64_t{v} + 1);
                    if (!view.normals.empty()) append_shortest(out += "//", std::uint64_t{v} + 1);
                }
                out += '\n';
                flush(file, out, flush_bytes);
            }
        }
    };
    write_faces(view.triangles, view.runs);
    write_faces(view.quads, view.quad_runs);
    flush(file, out, 0);
    file.commit();
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
    write_ply_of(path, mesh);
}
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& /*writing*/) {
    write_ply_of(path, mesh);
}

void write_obj(const std::filesystem::path& path, const Mesh& mesh) {
    write_obj_of(path, mesh);
}
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& /*writing*/) {
    write_obj_of(path, mesh);
}

}  // namespace meniscus::formats
