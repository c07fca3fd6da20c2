#include "web/mesh_glb.hpp"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "conversion/brick_conversion.hpp"
#include "files/centered_positions.hpp"
#include "files/glb_document.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"
#include "rpc/messages/wire_bytes.hpp"

namespace meniscus::server {

namespace {

constexpr std::uint64_t triangle_bytes = 12;
constexpr std::uint64_t position_and_normal_bytes = 24;

/// The bytes of one vertex's attributes.
std::uint64_t attribute_bytes(const v1::MeshBegin& mesh) {
    std::uint64_t bytes = 0;
    for (const v1::MeshAttribute& attribute : mesh.attributes())
        if (attribute.has_bits()) bytes += std::uint64_t{4} * attribute.components();
    return bytes;
}

/// A frame as it came.
struct Snapshot {
    v1::MeshBegin mesh;
    std::vector<EncodedBrick> bricks;
};

Snapshot snapshot_of(const std::vector<grpc::ByteBuffer>& messages) {
    Snapshot snapshot;
    for (const grpc::ByteBuffer& bytes : messages) {
        auto message = parsed<v1::WatchResponse>(bytes);
        if (message.has_mesh_begin()) {
            snapshot = {std::move(*message.mutable_mesh_begin()), {}};
        } else if (message.has_mesh_brick()) {
            if (message.mesh_brick().part_index() == 0) snapshot.bricks.emplace_back();
            if (snapshot.bricks.empty()) throw std::runtime_error("a snapshot begins within a brick");
            conversion::append_part(message.mesh_brick(), snapshot.bricks.back());
        }
    }
    return snapshot;
}

files::GlbRoot root_at(const std::array<double, 3>& place, v1::UpAxis up) {
    constexpr double half = 0.5, diagonal = std::numbers::sqrt2 / 2;
    const auto [x, y, z] = place;
    switch (up) {
        case v1::UP_AXIS_X:
            return {.translation = {z, x, y}, .rotation = {{half, half, half, half}}};
        case v1::UP_AXIS_Z:
            return {.translation = {x, z, -y}, .rotation = {{-diagonal, 0.0, 0.0, diagonal}}};
        default:
            return {.translation = place};
    }
}

Mesh welded(const Snapshot& snapshot, const std::atomic<bool>& canceled) {
    const std::vector<CodedAttribute> attributes = conversion::coded_attributes(snapshot.mesh);
    std::vector<DecodedBrick> decoded;
    decoded.reserve(snapshot.bricks.size());
    for (const EncodedBrick& brick : snapshot.bricks) {
        if (canceled) return {};
        decoded.push_back(decode_brick(brick, snapshot.mesh.offset_bits(), attributes));
    }
    return weld_bricks(decoded, snapshot.mesh.cell_size(), snapshot.mesh.offset_bits());
}

std::string plain_glb(const Snapshot& snapshot, v1::UpAxis up, const std::atomic<bool>& canceled) {
    const Mesh mesh = welded(snapshot, canceled);
    std::vector<std::array<double, 3>> world;
    world.reserve(mesh.vertices.size());
    for (const LatticePosition& vertex : mesh.vertices) world.push_back(mesh.world(vertex));
    const files::CenteredPositions centered(world);
    files::GlbDocument document(root_at(centered.middle, up));
    if (mesh.triangles.empty()) return std::move(document).file();
    std::vector<files::GlbVertices> vertices;
    vertices.push_back(files::glb_positions(centered.positions));
    if (!mesh.normals.empty()) vertices.push_back(files::glb_normals(mesh.normals));
    for (const MeshAttribute& each : mesh.attributes)
        if (auto attribute = files::glb_attribute(each.name, each.type, each.components, each.data);
            files::is_finite(attribute))
            vertices.push_back(std::move(attribute));
    document.add(vertices, mesh.triangles);
    return std::move(document).file();
}

/// The attribute's place in the file, by the number that Draco knows it by.
files::GlbDracoMesh::Attribute form_of(const draco::PointAttribute& attribute, const char* name,
                                       files::GlbComponent type) {
    return {{.name = name, .type = type}, attribute.unique_id()};
}

/// Decoded for its counts and its bounds, which the file names beside the bytes.
files::GlbDracoMesh as_it_is(const EncodedBrick& brick) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(brick.data.data()), brick.data.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) throw std::runtime_error("a brick cannot be read: " + decoded.status().error_msg_string());
    const draco::Mesh& mesh = *decoded.value();
    const draco::PointAttribute* positions = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (positions == nullptr || mesh.num_points() == 0) throw std::runtime_error("a brick has no positions");
    files::GlbDracoMesh out{.bytes = {reinterpret_cast<const char*>(brick.data.data()), brick.data.size()},
                            .points = mesh.num_points(),
                            .triangles = mesh.num_faces()};
    out.attributes.push_back(form_of(*positions, "POSITION", files::GlbComponent::unsigned_short));
    if (const auto* normals = mesh.GetNamedAttribute(draco::GeometryAttribute::NORMAL))
        out.attributes.push_back(form_of(*normals, "NORMAL", files::GlbComponent::single));
    out.bounds.low.fill(std::numeric_limits<std::uint16_t>::max());
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        std::array<std::uint16_t, 3> position{};
        positions->GetMappedValue(point, position.data());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.bounds.low[axis] = std::min<double>(out.bounds.low[axis], position[axis]);
            out.bounds.high[axis] = std::max<double>(out.bounds.high[axis], position[axis]);
        }
    }
    return out;
}

/// The root is at the first brick; the places of the others, from there, are small numbers.
std::string draco_glb(const Snapshot& snapshot, v1::UpAxis up, const std::atomic<bool>& canceled) {
    const double edge = snapshot.mesh.cell_size() * brick_cells;
    const double unit = snapshot.mesh.cell_size() / static_cast<double>(1U << snapshot.mesh.offset_bits());
    const std::array<std::int32_t, 3> first =
        snapshot.bricks.empty() ? std::array<std::int32_t, 3>{} : snapshot.bricks.front().coordinate;
    files::GlbDocument document(root_at({first[0] * edge, first[1] * edge, first[2] * edge}, up));
    for (const EncodedBrick& brick : snapshot.bricks) {
        if (canceled) break;
        if (brick.triangles == 0) continue;
        std::array<double, 3> place{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            place[axis] = (static_cast<double>(brick.coordinate[axis]) - first[axis]) * edge;
        const auto& [x, y, z] = brick.coordinate;
        document.add_part(fmt::format("brick {} {} {}", x, y, z), as_it_is(brick), place, unit);
    }
    return std::move(document).file();
}

}  // namespace

std::uint64_t bytes_for_glb(const MeshRequest& asked, const v1::MeshBegin& mesh) {
    // Per triangle. A surface has half as many vertices as triangles, and is there decoded, welded and written.
    const std::uint64_t each = asked.draco ? 32 : 160 + 2 * attribute_bytes(mesh);
    return mesh.triangle_count() * each;
}

void require_possible_glb(const MeshRequest& asked, const v1::MeshBegin& mesh) {
    const std::uint64_t least =
        asked.draco ? 0
                    : mesh.triangle_count() * triangle_bytes +
                          mesh.triangle_count() / 2 * (position_and_normal_bytes + attribute_bytes(mesh));
    if (least > std::numeric_limits<std::uint32_t>::max())
        throw LimitExceeded(
            fmt::format("the mesh has {} triangles: about {} bytes as GLB, which holds at most 4294967295; ask for "
                        "?draco, or for fewer attributes",
                        mesh.triangle_count(), least));
}

MeshGlb mesh_glb(const MeshRequest& asked, const std::vector<grpc::ByteBuffer>& messages, v1::UpAxis up,
                 const std::atomic<bool>& canceled) {
    Snapshot snapshot = snapshot_of(messages);
    std::string file = asked.draco ? draco_glb(snapshot, up, canceled) : plain_glb(snapshot, up, canceled);
    return {std::move(snapshot.mesh), std::move(file)};
}

}  // namespace meniscus::server
