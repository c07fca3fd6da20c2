// A Draco mesh, whose bytes are believed nothing, as a brick.
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "codec/attribute_values.hpp"
#include "codec/brick_refusal.hpp"
#include "codec/draco_attributes.hpp"
#include "codec/draco_bricks.hpp"
#include "codec/draco_header.hpp"
#include "codec/triangle_levels.hpp"

namespace meniscus {
namespace {

constexpr std::size_t cells_per_brick = std::size_t{brick_base_cells} * brick_base_cells * brick_base_cells;

/// Draco allocates by the counts that its bytes claim, before it finds that the bytes do not hold them. The counts are
/// compared first, with those announced and with the most that this number of bytes can hold.
void require_plausible(const EncodedBrick& brick, std::size_t attributes) {
    if (brick.triangles > max_brick_triangles || brick.vertices > max_brick_triangles)
        refuse(brick, "announces " + std::to_string(brick.triangles) + " triangles and " +
                          std::to_string(brick.vertices) + " vertices, a brick has at most " +
                          std::to_string(max_brick_triangles) + " of each");
    // The smoothest surface takes an eighth of a byte per triangle at the speed that is in use.
    constexpr std::size_t most_per_byte = 64;
    if (brick.triangles / most_per_byte > brick.data.size())
        refuse(brick, "announces " + std::to_string(brick.triangles) + " triangles in " +
                          std::to_string(brick.data.size()) + " bytes, more than " + std::to_string(most_per_byte) +
                          " per byte");
    const auto header = read_draco_header(brick.data);
    if (!header) refuse(brick, "its bytes are not a Draco mesh as bricks have them");
    if (header->faces != brick.triangles)
        refuse(brick, "has " + std::to_string(header->faces) + " triangles, announced were " +
                          std::to_string(brick.triangles));
    if (header->vertices > 3 * header->faces || header->symbols > header->faces ||
        header->split_symbols > header->symbols || header->attribute_connectivities > 1 + attributes)
        refuse(brick, "its Draco mesh has " + std::to_string(header->vertices) + " vertices, " +
                          std::to_string(header->symbols) + " symbols, " + std::to_string(header->split_symbols) +
                          " splits and " + std::to_string(header->attribute_connectivities) +
                          " more connectivities, which do not fit " + std::to_string(header->faces) + " triangles");
}

/// Looks at the attributes once Draco has read what they are, before it allocates their values.
class AnnouncedMeshDecoder : public draco::MeshEdgebreakerDecoder {
public:
    explicit AnnouncedMeshDecoder(std::span<const CodedAttribute> announced) : announced_(announced) {}

    const std::string& misfit() const { return misfit_; }

protected:
    bool DecodeAllAttributes() override {
        misfit_ = meniscus::misfit(*point_cloud(), announced_);
        return misfit_.empty() && MeshEdgebreakerDecoder::DecodeAllAttributes();
    }

private:
    std::span<const CodedAttribute> announced_;
    std::string misfit_;
};

std::unique_ptr<draco::Mesh> decoded_mesh(const EncodedBrick& brick, std::span<const CodedAttribute> announced) {
    require_plausible(brick, announced.size());
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(brick.data.data()), brick.data.size());
    AnnouncedMeshDecoder decoder(announced);
    auto mesh = std::make_unique<draco::Mesh>();
    const draco::Status status = decoder.Decode({}, &buffer, mesh.get());
    if (!decoder.misfit().empty()) refuse(brick, decoder.misfit());
    if (!status.ok()) refuse(brick, "its bytes are not a Draco mesh (" + status.error_msg_string() + ")");
    return mesh;
}

/// For every point of the Draco mesh, the vertex that it belongs to: points at one position are one vertex.
struct Weld {
    std::vector<LocalPosition> positions;  ///< positions of the vertices, ascending
    std::vector<std::uint32_t> vertex_of_point;
    std::vector<std::uint32_t> point_of_vertex;  ///< first point of each vertex
};

Weld weld_points(const EncodedBrick& brick, const draco::Mesh& mesh) {
    const draco::PointAttribute* attribute = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (attribute == nullptr) refuse(brick, "its Draco mesh has no positions");
    const std::uint32_t points = mesh.num_points();
    std::vector<std::pair<LocalPosition, std::uint32_t>> sorted;
    sorted.reserve(points);
    for (std::uint32_t p = 0; p < points; ++p) {
        const auto value = attribute->mapped_index(draco::PointIndex(p));
        if (value.value() >= attribute->size()) refuse(brick, "a point names a position that is not there");
        LocalPosition position;
        attribute->GetValue(value, &position);
        sorted.emplace_back(position, p);
    }
    std::sort(sorted.begin(), sorted.end());
    Weld weld;
    weld.vertex_of_point.resize(points);
    for (const auto& [position, point] : sorted) {
        if (weld.positions.empty() || weld.positions.back() != position) {
            weld.positions.push_back(position);
            weld.point_of_vertex.push_back(point);
        }
        weld.vertex_of_point[point] = static_cast<std::uint32_t>(weld.positions.size() - 1);
    }
    return weld;
}

/// The normal of a point at unit length.
Normal decoded_normal(const draco::PointAttribute& attribute, std::uint32_t point) {
    std::array<float, 3> n{};
    attribute.ConvertValue<float>(attribute.mapped_index(draco::PointIndex(point)), 3, n.data());
    const float size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(size > 0.0F) || !std::isfinite(size)) return {0.0F, 0.0F, 1.0F};
    return {n[0] / size, n[1] / size, n[2] / size};
}

}  // namespace

DecodedBrick decode_draco(const EncodedBrick& brick, const LatticePosition& origin, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes) {
    const auto mesh = decoded_mesh(brick, attributes);
    const Weld weld = weld_points(brick, *mesh);
    if (mesh->num_faces() != brick.triangles || weld.positions.size() != brick.vertices)
        refuse(brick, "has " + std::to_string(mesh->num_faces()) + " triangles and " +
                          std::to_string(weld.positions.size()) + " vertices, announced were " +
                          std::to_string(brick.triangles) + " and " + std::to_string(brick.vertices));
    const int last = brick_cells << offset_bits;
    DecodedBrick decoded;
    decoded.coordinate = brick.coordinate;
    decoded.vertices.reserve(weld.positions.size());
    for (const LocalPosition& p : weld.positions) {
        if (p[0] > last || p[1] > last || p[2] > last) refuse(brick, "a vertex lies outside of it");
        decoded.vertices.push_back({origin[0] + p[0], origin[1] + p[1], origin[2] + p[2]});
    }
    if (const auto* attribute = mesh->GetNamedAttribute(draco::GeometryAttribute::NORMAL)) {
        decoded.normals.reserve(weld.positions.size());
        for (const std::uint32_t point : weld.point_of_vertex)
            decoded.normals.push_back(decoded_normal(*attribute, point));
    }
    for (std::size_t a = 0; a < attributes.size(); ++a)
        decoded.attributes.push_back(
            decoded_values(attributes[a], draco_attribute(*mesh, a, attributes[a], weld.point_of_vertex)));
    std::vector<std::optional<std::uint16_t>> cells;
    std::array<bool, cells_per_brick> occupied{};
    for (std::uint32_t t = 0; t < brick.triangles; ++t) {
        const auto& face = mesh->face(draco::FaceIndex(t));
        Triangle triangle;
        for (std::size_t i = 0; i < 3; ++i) {
            if (face[i].value() >= weld.vertex_of_point.size())
                refuse(brick, "a triangle names a point that is not there");
            triangle[i] = weld.vertex_of_point[face[i].value()];
        }
        decoded.triangles.push_back(triangle);
        cells.push_back(cell_of_triangle(weld.positions[triangle[0]], weld.positions[triangle[1]],
                                         weld.positions[triangle[2]], offset_bits));
        if (cells.back()) occupied[*cells.back()] = true;
    }
    const std::vector<std::uint8_t> levels = unpack_cell_levels(brick.cell_levels, occupied);
    decoded.levels.reserve(cells.size());
    for (const auto& cell : cells)
        decoded.levels.push_back(cell ? static_cast<TriangleLevel>(levels[*cell] - 1) : TriangleLevel::crack);
    return decoded;
}

}  // namespace meniscus
