#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "coding/triangle_levels.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

/// The brick's triangles over vertices of its own, numbered as they are met.
struct BrickIndex {
    std::vector<std::uint32_t> vertices;  ///< into the mesh
    std::vector<Triangle> triangles;      ///< into `vertices`
};

BrickIndex index_brick(const Mesh& mesh, const MeshBrick& brick) {
    // From a mesh's vertex to the brick's: an entry holds only if the brick's vertex points back, so that what earlier bricks
    // have left behind need not be cleared. One table per thread, as large as the largest mesh.
    thread_local std::vector<std::uint32_t> local_of;
    if (local_of.size() < mesh.vertices.size()) local_of.resize(mesh.vertices.size());
    BrickIndex index;
    index.vertices.reserve(brick.triangle_count());
    index.triangles.reserve(brick.triangle_count());
    for (const TriangleRange& range : brick.ranges)
        for (std::uint32_t t = 0; t < range.count; ++t) {
            Triangle local;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t v = mesh.triangles[range.first + t][i];
                if (local_of[v] >= index.vertices.size() || index.vertices[local_of[v]] != v) {
                    local_of[v] = static_cast<std::uint32_t>(index.vertices.size());
                    index.vertices.push_back(v);
                }
                local[i] = local_of[v];
            }
            index.triangles.push_back(local);
        }
    return index;
}

std::vector<LocalPosition> local_positions(const Mesh& mesh, const MeshBrick& brick, const std::vector<std::uint32_t>& vertices) {
    std::vector<LocalPosition> positions;
    positions.reserve(vertices.size());
    for (const std::uint32_t v : vertices) {
        LocalPosition local;
        for (std::size_t axis = 0; axis < 3; ++axis)
            local[axis] = static_cast<std::uint16_t>(mesh.vertices[v][axis] - brick.coordinate[axis] * (brick_cells << mesh.offset_bits));
        positions.push_back(local);
    }
    return positions;
}

std::vector<std::byte> cell_levels(const Mesh& mesh, const MeshBrick& brick, const BrickIndex& index,
                                   const std::vector<LocalPosition>& positions) {
    std::array<std::uint8_t, std::size_t{brick_base_cells} * brick_base_cells * brick_base_cells> level_of_cell{};
    std::size_t t = 0;
    for (std::size_t level = 0; level < triangle_level_count; ++level)
        for (std::uint32_t i = 0; i < brick.ranges[level].count; ++i, ++t) {
            const Triangle& triangle = index.triangles[t];
            const auto cell = cell_of_triangle(positions[triangle[0]], positions[triangle[1]], positions[triangle[2]], mesh.offset_bits);
            if (cell) level_of_cell[*cell] = level_byte(static_cast<TriangleLevel>(level));
        }
    return pack_cell_levels(level_of_cell);
}

template <class Value>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type, const std::vector<Value>& values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, 3, data_type, false, sizeof(Value), 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<draco::AttributeValueIndex::ValueType>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<std::uint32_t>(i)), values[i].data());
    return id;
}

}  // namespace

EncodedBrick encode_brick(const Mesh& mesh, std::size_t brick_number, const CodingOptions& options) {
    if (options.normal_bits != 0 && (options.normal_bits < 2 || options.normal_bits > 16))
        throw InvalidInput("normal bits are " + std::to_string(options.normal_bits) + ", must be 2 to 16, or 0 for no normals");
    if (options.speed < 0 || options.speed > 10)
        throw InvalidInput("coding speed is " + std::to_string(options.speed) + ", must be 0 to 10");
    const MeshBrick& brick = mesh.bricks.at(brick_number);
    const BrickIndex index = index_brick(mesh, brick);
    const std::vector<LocalPosition> positions = local_positions(mesh, brick, index.vertices);

    EncodedBrick encoded;
    encoded.coordinate = brick.coordinate;
    encoded.vertices = static_cast<std::uint32_t>(index.vertices.size());
    encoded.triangles = static_cast<std::uint32_t>(index.triangles.size());
    encoded.cell_levels = cell_levels(mesh, brick, index, positions);

    draco::Mesh draco_mesh;
    draco_mesh.set_num_points(encoded.vertices);
    draco_mesh.SetNumFaces(encoded.triangles);
    for (std::uint32_t t = 0; t < encoded.triangles; ++t) {
        const Triangle& triangle = index.triangles[t];
        draco_mesh.SetFace(draco::FaceIndex(t), {{draco::PointIndex(triangle[0]), draco::PointIndex(triangle[1]), draco::PointIndex(triangle[2])}});
    }
    add_attribute(draco_mesh, draco::GeometryAttribute::POSITION, draco::DT_UINT16, positions);
    int normals = -1;
    if (options.normal_bits != 0 && !mesh.normals.empty()) {
        std::vector<Normal> values;
        values.reserve(index.vertices.size());
        for (const std::uint32_t v : index.vertices) values.push_back(mesh.normals[v]);
        normals = add_attribute(draco_mesh, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, values);
    }
    draco::ExpertEncoder encoder(draco_mesh);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(options.speed, options.speed);
    if (normals >= 0) encoder.SetAttributeQuantization(normals, options.normal_bits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok()) throw std::runtime_error("Draco could not encode a brick: " + status.error_msg_string());
    const auto* bytes = reinterpret_cast<const std::byte*>(buffer.data());
    encoded.draco.assign(bytes, bytes + buffer.size());
    return encoded;
}

}  // namespace meniscus
