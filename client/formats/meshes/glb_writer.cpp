// A mesh as GLB: positions are float32 around the middle of the mesh; a node puts them in place, by float64.
#include "formats/meshes/glb_writer.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "files/centered_positions.hpp"
#include "files/glb_document.hpp"
#include "formats/bytes/atomic_file.hpp"

namespace meniscus::formats {
namespace {

using files::GlbComponent;
using files::GlbVertices;

std::vector<GlbVertices> all_vertices(const TriangleMesh& mesh, const std::vector<std::array<float, 3>>& positions) {
    std::vector<GlbVertices> all;
    all.push_back(files::glb_positions(positions));
    // The positions of a mesh are finite; what else a file of strangers has need not be.
    const auto add = [&](GlbVertices vertices) {
        if (files::is_finite(vertices)) all.push_back(std::move(vertices));
    };
    if (mesh.normals.size() == positions.size()) add(files::glb_normals(mesh.normals));
    for (const NamedValues& values : mesh.attributes)
        add(files::glb_attribute(values.name, values.type, values.components, values.data));
    return all;
}

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

files::GlbBounds bounds_of(const std::vector<std::array<float, 3>>& positions) {
    files::GlbBounds bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax_element(
            positions.begin(), positions.end(), [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        bounds.low[axis] = (*low)[axis];
        bounds.high[axis] = (*high)[axis];
    }
    return bounds;
}

/// all: the positions first.
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

}  // namespace

std::string to_glb(const TriangleMesh& mesh, GlbCoding coding) {
    const files::CenteredPositions centered(mesh.positions);
    files::GlbDocument document({.translation = centered.middle});
    if (!mesh.triangles.empty()) {
        const std::vector<GlbVertices> all = all_vertices(mesh, centered.positions);
        if (coding == GlbCoding::draco)
            add_draco(all, bounds_of(centered.positions), mesh.triangles, document);
        else
            document.add(all, mesh.triangles);
    }
    return std::move(document).file();
}

void write_glb(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing) {
    write_file(path, to_glb(mesh, writing.compress ? GlbCoding::draco : GlbCoding::plain));
}

}  // namespace meniscus::formats
