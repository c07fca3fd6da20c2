#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {
namespace {

using Place = std::array<double, 3>;

/// Of unit length, outward; 0 for a triangle without an area.
Place normal_of(const Place& a, const Place& b, const Place& c) {
    Place u{}, v{};
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
    }
    Place out{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(out[0], out[1], out[2]);
    if (length > 0.0)
        for (double& x : out) x /= length;
    return out;
}

}  // namespace

void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& /*writing*/) {
    constexpr std::size_t header_bytes = 80;
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
    if (mesh.triangles.size() > most)
        throw InvalidInput(output_name(path) + ": STL holds at most " + std::to_string(most) +
                           " triangles: write .ply or .vtu");
    std::string out = "Meniscus surface";  // not "solid", by which readers know STL as text
    out.resize(header_bytes, ' ');
    store(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    AtomicFile file(path);
    for (const Triangle& triangle : mesh.triangles) {
        const Place& a = mesh.positions[triangle[0]];
        const Place& b = mesh.positions[triangle[1]];
        const Place& c = mesh.positions[triangle[2]];
        const Place normal = normal_of(a, b, c);
        for (const Place* place : {&normal, &a, &b, &c})
            for (const double x : *place) store(out, static_cast<float>(x));
        store(out, std::uint16_t{0});
        file.write(out);
        out.clear();
    }
    file.write(out);
    file.commit();
}

}  // namespace meniscus::formats
