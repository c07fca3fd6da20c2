#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <string>

#include "formats/atomic_file.hpp"
#include "formats/mesh_file.hpp"

namespace meniscus::formats {
namespace {

constexpr std::size_t flush_bytes = std::size_t{1} << 20;

/// The shortest decimal that reads back as the same number.
template <class T>
void append(std::string& out, T value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    out.append(digits.data(), end);
}

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

}  // namespace

bool needs_double(const Mesh& mesh) {
    constexpr std::int32_t limit = 1 << 23;
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [](const LatticePosition& p) {
        return std::any_of(p.begin(), p.end(), [](std::int32_t x) { return x <= -limit || x >= limit; });
    });
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
    const bool wide = needs_double(mesh);
    const bool normals = mesh.normals.size() == mesh.vertices.size();
    const std::string type = wide ? "double " : "float ";
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment Meniscus: face level 1, 2, 3; crack filling 0\n";
    out += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += "property " + type + axis + "\n";
    if (normals) out += "property float nx\nproperty float ny\nproperty float nz\n";
    out += "element face " + std::to_string(mesh.triangles.size()) + "\n";
    out += "property list uchar uint vertex_indices\nproperty uchar level\nend_header\n";
    AtomicFile file(path);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const std::array<double, 3> place = mesh.world(mesh.vertices[i]);
        if (wide)
            append_bytes(out, place);
        else
            append_bytes(out, std::array{static_cast<float>(place[0]), static_cast<float>(place[1]),
                                         static_cast<float>(place[2])});
        if (normals) append_bytes(out, mesh.normals[i]);
        flush(file, out, flush_bytes);
    }
    for (const TriangleLevel level : choices<TriangleLevel>) {
        const TriangleRange range = mesh.levels[static_cast<std::size_t>(level)];
        for (std::size_t i = range.first; i < std::size_t{range.first} + range.count; ++i) {
            out += char{3};
            append_bytes(out, mesh.triangles[i]);
            out += static_cast<char>(level_byte(level));
            flush(file, out, flush_bytes);
        }
    }
    flush(file, out, 0);
    file.commit();
}

void write_obj(const std::filesystem::path& path, const Mesh& mesh) {
    const bool wide = needs_double(mesh);
    const bool normals = mesh.normals.size() == mesh.vertices.size();
    std::string out = "# Meniscus\n";
    AtomicFile file(path);
    for (const LatticePosition& vertex : mesh.vertices) {
        out += 'v';
        for (const double x : mesh.world(vertex)) {
            out += ' ';
            if (wide)
                append(out, x);
            else
                append(out, static_cast<float>(x));
        }
        out += '\n';
        flush(file, out, flush_bytes);
    }
    for (std::size_t i = 0; normals && i < mesh.normals.size(); ++i) {
        out += "vn";
        for (const float x : mesh.normals[i]) append(out += ' ', x);
        out += '\n';
        flush(file, out, flush_bytes);
    }
    for (const TriangleLevel level : choices<TriangleLevel>) {
        const TriangleRange range = mesh.levels[static_cast<std::size_t>(level)];
        if (range.count == 0) continue;
        out += "g " + std::string(name_of(level)) + "\n";
        for (std::size_t i = range.first; i < std::size_t{range.first} + range.count; ++i) {
            out += 'f';
            for (const std::uint32_t v : mesh.triangles[i]) {
                append(out += ' ', std::uint64_t{v} + 1);
                if (normals) append(out += "//", std::uint64_t{v} + 1);
            }
            out += '\n';
            flush(file, out, flush_bytes);
        }
    }
    flush(file, out, 0);
    file.commit();
}

}  // namespace meniscus::formats
