// A brick's content as a Draco mesh of its own.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <stdexcept>
#include <string>

#include "codec/draco_attributes.hpp"
#include "codec/draco_bricks.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

template <class Value>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type,
                  const std::vector<Value>& values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, 3, data_type, false, sizeof(Value), 0);
    const int id =
        mesh.AddAttribute(attribute, true, static_cast<draco::AttributeValueIndex::ValueType>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<std::uint32_t>(i)),
                                              values[i].data());
    return id;
}

}  // namespace

std::vector<std::byte> encode_draco(const BrickContent& content, const CodingOptions& options) {
    if (options.speed < 0 || options.speed > 10)
        throw InvalidInput("coding speed is " + std::to_string(options.speed) + ", must be 0 to 10");
    draco::Mesh draco_mesh;
    draco_mesh.set_num_points(static_cast<std::uint32_t>(content.positions.size()));
    draco_mesh.SetNumFaces(content.triangles.size());
    for (std::uint32_t t = 0; t < content.triangles.size(); ++t) {
        const Triangle& triangle = content.triangles[t];
        draco_mesh.SetFace(draco::FaceIndex(t), {{draco::PointIndex(triangle[0]), draco::PointIndex(triangle[1]),
                                                  draco::PointIndex(triangle[2])}});
    }
    add_attribute(draco_mesh, draco::GeometryAttribute::POSITION, draco::DT_UINT16, content.positions);
    draco::ExpertEncoder encoder(draco_mesh);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(options.speed, options.speed);
    if (!content.normals.empty()) {
        const int normals =
            add_attribute(draco_mesh, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, content.normals);
        encoder.SetAttributeQuantization(normals, options.normal_bits);
    }
    for (std::size_t a = 0; a < content.attributes.size(); ++a)
        add_draco_attribute(draco_mesh, a, content.attribute_forms[a], content.attributes[a]);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok()) throw std::runtime_error("Draco could not encode a brick: " + status.error_msg_string());
    const auto* bytes = reinterpret_cast<const std::byte*>(buffer.data());
    return {bytes, bytes + buffer.size()};
}

}  // namespace meniscus
