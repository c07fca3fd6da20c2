#include "one_piece.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace meniscus::benchmarks {
namespace {

template <class Number>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type, std::size_t count,
                  const auto& value_of) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, 3, data_type, false, 3 * sizeof(Number), 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<Number, 3> value = value_of(i);
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<std::uint32_t>(i)), value.data());
    }
    return id;
}

template <class Number>
void add_positions(draco::Mesh& out, draco::DataType data_type, const Mesh& mesh, const LatticePosition& low) {
    add_attribute<Number>(out, draco::GeometryAttribute::POSITION, data_type, mesh.vertices.size(), [&](std::size_t i) {
        std::array<Number, 3> value;
        for (std::size_t axis = 0; axis < 3; ++axis)
            value[axis] = static_cast<Number>(mesh.vertices[i][axis] - low[axis]);
        return value;
    });
}

void add_positions(draco::Mesh& out, const Mesh& mesh) {
    LatticePosition low = mesh.vertices.front();
    LatticePosition high = low;
    for (const LatticePosition& vertex : mesh.vertices)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], vertex[axis]);
            high[axis] = std::max(high[axis], vertex[axis]);
        }
    int extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, high[axis] - low[axis]);
    if (extent <= std::numeric_limits<std::uint16_t>::max())
        add_positions<std::uint16_t>(out, draco::DT_UINT16, mesh, low);
    else
        add_positions<std::uint32_t>(out, draco::DT_UINT32, mesh, low);
}

}  // namespace

std::size_t encode_in_one_piece(const Mesh& mesh, const CodingOptions& options) {
    draco::Mesh out;
    out.set_num_points(static_cast<std::uint32_t>(mesh.vertices.size()));
    out.SetNumFaces(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& triangle = mesh.triangles[t];
        out.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(t)),
                    {{draco::PointIndex(triangle[0]), draco::PointIndex(triangle[1]), draco::PointIndex(triangle[2])}});
    }
    add_positions(out, mesh);
    int normals = -1;
    if (options.normal_bits != 0)
        normals = add_attribute<float>(out, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, mesh.normals.size(),
                                       [&](std::size_t i) { return mesh.normals[i]; });
    draco::ExpertEncoder encoder(out);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(options.speed, options.speed);
    if (normals >= 0) encoder.SetAttributeQuantization(normals, options.normal_bits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok()) throw std::runtime_error("Draco could not encode the mesh: " + status.error_msg_string());
    return buffer.size();
}

}  // namespace meniscus::benchmarks
