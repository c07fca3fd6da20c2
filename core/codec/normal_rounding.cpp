#include "codec/normal_rounding.hpp"

#include <draco/attributes/attribute_octahedron_transform.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "codec/coded_bits.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus {

Normal decoded_normal(const draco::PointAttribute& attribute, std::uint32_t point) {
    std::array<float, 3> n{};
    attribute.ConvertValue<float>(attribute.mapped_index(draco::PointIndex(point)), 3, n.data());
    const float size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(size > 0.0F) || !std::isfinite(size)) return {0.0F, 0.0F, 1.0F};
    return {n[0] / size, n[1] / size, n[2] / size};
}

void round_normals(Mesh& mesh, int normal_bits) {
    check_normal_bits(normal_bits);
    if (normal_bits == 0) mesh.normals.clear();
    if (mesh.normals.empty()) return;
    const auto count = static_cast<std::uint32_t>(mesh.normals.size());
    draco::PointAttribute normals;
    normals.Init(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32, false, count);
    for (std::uint32_t v = 0; v < count; ++v)
        normals.SetAttributeValue(draco::AttributeValueIndex(v), mesh.normals[v].data());
    // Draco's encoder and decoder go through this transform, too.
    draco::AttributeOctahedronTransform transform;
    transform.SetParameters(normal_bits);
    const auto rounded = transform.InitTransformedAttribute(normals, static_cast<int>(count));
    if (!transform.TransformAttribute(normals, {}, rounded.get()) ||
        !transform.InverseTransformAttribute(*rounded, &normals))
        throw std::runtime_error("Draco could not round normals to " + std::to_string(normal_bits) + " bits");
    for (std::uint32_t v = 0; v < count; ++v) mesh.normals[v] = decoded_normal(normals, v);
}

}  // namespace meniscus
