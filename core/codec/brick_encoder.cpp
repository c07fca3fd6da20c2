// The part of a mesh that is one brick, and its encoding.
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "codec/attribute_values.hpp"
#include "codec/brick_index.hpp"
#include "codec/coded_bits.hpp"
#include "codec/draco_bricks.hpp"
#include "codec/round_position.hpp"
#include "codec/triangle_levels.hpp"
#include "meniscus/array_form.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

std::vector<LocalPosition> local_positions(const Mesh& mesh, const MeshBrick& brick,
                                           const std::vector<std::uint32_t>& vertices, std::uint32_t bits) {
    std::vector<LocalPosition> positions;
    positions.reserve(vertices.size());
    for (const std::uint32_t v : vertices) {
        LocalPosition local;
        for (std::size_t axis = 0; axis < 3; ++axis)
            local[axis] =
                round_position(static_cast<std::uint16_t>(mesh.vertices[v][axis] -
                                                          brick.coordinate[axis] * (brick_cells << mesh.offset_bits)),
                               mesh.offset_bits, bits);
        positions.push_back(local);
    }
    return positions;
}

/// level_of: from a triangle's index to its level.
template <class LevelOf>
std::vector<std::byte> cell_levels(const std::vector<Triangle>& triangles, const std::vector<LocalPosition>& positions,
                                   std::uint32_t bits, const LevelOf& level_of) {
    std::array<std::uint8_t, std::size_t{brick_base_cells} * brick_base_cells * brick_base_cells> level_of_cell{};
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const Triangle& triangle = triangles[t];
        const auto cell =
            cell_of_triangle(positions[triangle[0]], positions[triangle[1]], positions[triangle[2]], bits);
        if (cell) level_of_cell[*cell] = level_byte(level_of(t));
    }
    return pack_cell_levels(level_of_cell);
}

/// The levels of a brick's triangles, which are ordered by level.
TriangleLevel level_at(const MeshBrick& brick, std::size_t triangle) {
    std::size_t level = 0;
    for (std::size_t end = brick.ranges[0].count; triangle >= end; end += brick.ranges[level].count) ++level;
    return static_cast<TriangleLevel>(level);
}

std::vector<std::byte> encode(const BrickContent& content, const CodingOptions& options) {
    switch (options.codec) {
        case Codec::draco:
            return encode_draco(content, options);
        case Codec::lattice_packed:
        case Codec::lattice_entropy:
            throw InvalidInput("codec is " + std::string(name_of(options.codec)) +
                               ", which codes a mesh by its lattice: encode the mesh, not a content of triangles");
    }
    throw InvalidInput("codec is " + std::to_string(static_cast<std::uint32_t>(options.codec)) +
                       ", which this version does not know; it knows " + known_codecs());
}

}  // namespace

BrickContent brick_content(const Mesh& mesh, std::size_t brick_number, const CodingOptions& options,
                           BrickScratch& scratch) {
    check_normal_bits(options.normal_bits);
    const std::uint32_t bits = encoded_offset_bits(mesh, options);
    const MeshBrick& brick = mesh.bricks.at(brick_number);
    BrickIndex index = index_brick(mesh, brick, scratch.slots);

    BrickContent content;
    content.coordinate = brick.coordinate;
    content.positions = local_positions(mesh, brick, index.vertices, bits);
    content.cell_levels =
        cell_levels(index.triangles, content.positions, bits, [&brick](std::size_t t) { return level_at(brick, t); });
    content.triangles = std::move(index.triangles);
    if (options.normal_bits != 0 && !mesh.normals.empty()) {
        content.normals.reserve(index.vertices.size());
        for (const std::uint32_t v : index.vertices) content.normals.push_back(mesh.normals[v]);
    }
    for (const CodedAttribute& form : options.attributes)
        content.attributes.push_back(coded_values(attribute_of(mesh, form), form, index.vertices));
    content.attribute_forms = options.attributes;
    return content;
}

BrickContent brick_content(const Mesh& mesh, std::size_t brick, const CodingOptions& options) {
    BrickScratch scratch;
    return brick_content(mesh, brick, options, scratch);
}

EncodedBrick encode_brick(const BrickContent& content, const CodingOptions& options) {
    EncodedBrick encoded;
    encoded.coordinate = content.coordinate;
    encoded.vertices = static_cast<std::uint32_t>(content.positions.size());
    encoded.triangles = static_cast<std::uint32_t>(content.triangles.size());
    encoded.cell_levels = content.cell_levels;
    encoded.codec = options.codec;
    encoded.data = encode(content, options);
    return encoded;
}

EncodedBrick encode_brick(const DecodedBrick& brick, std::uint32_t offset_bits, const CodingOptions& options) {
    check_normal_bits(options.normal_bits);
    BrickContent content;
    content.coordinate = brick.coordinate;
    content.positions.reserve(brick.vertices.size());
    for (const LatticePosition& p : brick.vertices) {
        LocalPosition local;
        for (std::size_t axis = 0; axis < 3; ++axis)
            local[axis] = static_cast<std::uint16_t>(p[axis] - brick.coordinate[axis] * (brick_cells << offset_bits));
        content.positions.push_back(local);
    }
    content.triangles = brick.triangles;
    content.cell_levels = cell_levels(content.triangles, content.positions, offset_bits,
                                      [&brick](std::size_t t) { return brick.levels[t]; });
    if (options.normal_bits != 0) content.normals = brick.normals;
    std::vector<std::uint32_t> all(brick.vertices.size());
    std::iota(all.begin(), all.end(), 0U);
    for (std::size_t a = 0; a < options.attributes.size(); ++a)
        content.attributes.push_back(coded_values(brick.attributes.at(a), options.attributes[a], all));
    content.attribute_forms = options.attributes;
    return encode_brick(content, options);
}

EncodedBrick encode_brick(const Mesh& mesh, std::size_t brick, const CodingOptions& options) {
    thread_local BrickScratch scratch;
    return PreparedBrick(mesh, brick, options, scratch).encode();
}

}  // namespace meniscus
