#include "formats/meshes/glb_draco.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <stdexcept>
#include <string>

namespace meniscus::formats {
namespace {

using files::GlbComponent;
using files::GlbVertices;

draco::DataType draco_type(GlbComponent type) {
    return type == GlbComponent::single           ? draco::DT_FLOAT32
           : type == GlbComponent::unsigned_short ? draco::DT_UINT16
                                                  : draco::DT_UINT8;
}

draco::GeometryAttribute::Type draco_kind(const std::string& name) {
    if (name == "POSITION") return draco::GeometryAttribute::POSITION;
    if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
    return name == "COLOR_0" ? draco::GeometryAttribute::COLOR : draco::GeometryAttribute::GENERIC;
}

}  // namespace

void add_draco(const std::vector<GlbVertices>& all, const files::GlbBounds& bounds,
               const std::vector<Triangle>& triangles, files::GlbDocument& document) {
    // A lattice of 2^16 points a side over the mesh; normals as fine as they are seen.
    constexpr int position_bits = 16, normal_bits = 10;
    draco::Mesh mesh;
    const auto count = static_cast<std::uint32_t>(all.front().bytes.size() / all.front().vertex_bytes());
    mesh.set_num_points(count);
    mesh.SetNumFaces(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        mesh.SetFace(draco::FaceIndex(t), {{draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)}});
    }
    files::GlbDracoMesh coded;
    coded.bounds = bounds;
    for (const GlbVertices& vertices : all) {
        draco::GeometryAttribute attribute;
        attribute.Init(draco_kind(vertices.name), nullptr, static_cast<std::uint8_t>(vertices.components),
                       draco_type(vertices.type), vertices.normalized,
                       static_cast<std::int64_t>(vertices.vertex_bytes()), 0);
        const int id = mesh.AddAttribute(attribute, true, count);
        for (std::uint32_t v = 0; v < count; ++v)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                                  vertices.bytes.data() + v * vertices.vertex_bytes());
        coded.attributes.push_back({{vertices.name, vertices.type, vertices.components, vertices.normalized},
                                    mesh.attribute(id)->unique_id()});
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetTrackEncodedProperties(true);
    encoder.SetAttributeQuantization(0, position_bits);
    if (all.size() > 1 && all[1].name == "NORMAL") encoder.SetAttributeQuantization(1, normal_bits);
    draco::EncoderBuffer encoded;
    const draco::Status status = encoder.EncodeToBuffer(&encoded);
    if (!status.ok()) throw std::runtime_error("Draco could not encode the mesh: " + status.error_msg_string());
    coded.bytes = {encoded.data(), encoded.size()};
    coded.points = encoder.num_encoded_points();
    coded.triangles = encoder.num_encoded_faces();
    document.add(coded);
}

}  // namespace meniscus::formats
