// The rounding of normals on their way through any codec, of which all round alike.
#include "codec/coded_bits.hpp"
#include "codec/lattice/octahedron.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus {

void round_normals(Mesh& mesh, int normal_bits) {
    check_normal_bits(normal_bits);
    if (normal_bits == 0) return mesh.normals.clear();
    const Octahedron octahedron(normal_bits);
    for (Normal& normal : mesh.normals) normal = octahedron.vector(octahedron.code(octahedron.point(normal)));
}

}  // namespace meniscus
