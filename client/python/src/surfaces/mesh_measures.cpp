#include "surfaces/mesh_measures.hpp"

#include <cmath>
#include <cstddef>

namespace meniscus::python {
namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Lattice units, exact: coordinates have 32 bits.
Vector difference(const LatticePosition& to, const LatticePosition& from) {
    Vector out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<double>(to[i]) - static_cast<double>(from[i]);
    return out;
}

double unit_of(const Mesh& mesh) {
    return mesh.cell_size / static_cast<double>(1U << mesh.offset_bits);
}

}  // namespace

double area_of(const Mesh& mesh) {
    double twice = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const LatticePosition& corner = mesh.vertices[t[0]];
        const Vector normal = cross(difference(mesh.vertices[t[1]], corner), difference(mesh.vertices[t[2]], corner));
        twice += std::sqrt(dot(normal, normal));
    }
    const double unit = unit_of(mesh);
    return 0.5 * twice * unit * unit;
}

double volume_of(const Mesh& mesh) {
    if (mesh.triangles.empty()) return 0.0;
    // Tetrahedra with a corner on the surface are smaller, and so are their sum's errors, than with one far away.
    const LatticePosition& top = mesh.vertices[mesh.triangles[0][0]];
    double six_times = 0.0;
    for (const Triangle& t : mesh.triangles)
        six_times += dot(difference(mesh.vertices[t[0]], top),
                         cross(difference(mesh.vertices[t[1]], top), difference(mesh.vertices[t[2]], top)));
    const double unit = unit_of(mesh);
    return six_times / 6.0 * unit * unit * unit;
}

}  // namespace meniscus::python
