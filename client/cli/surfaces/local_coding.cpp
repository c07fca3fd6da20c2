#include "cli/surfaces/local_coding.hpp"

#include "meniscus/mesh_normals.hpp"

namespace meniscus::cli {

CodingOptions LocalCoding::round(Mesh& mesh) const {
    const std::vector<AttributeWish> attributes{{.name = {}, .bits = attribute_bits}};
    CodingOptions coding{.codec = codec};
    if (normals_by == client::NormalsBy::receiver) compute_normals(mesh);
    if (normal_bits) {
        round_normals(mesh, *normal_bits);
        coding.normal_bits = *normal_bits;
    }
    // Before they are rounded, as a server does: the range of what is rounded may be another.
    coding.attributes = coded_attributes(mesh, attribute_ranges(mesh), attributes);
    round_attributes(mesh, attributes);
    return coding;
}

}  // namespace meniscus::cli
