#include <chrono>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/client/client.hpp"
#include "meniscus/client/surface_part.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_normals.hpp"

namespace meniscus::client {

namespace {

std::vector<FrameAttribute> attributes_of(const Mesh& mesh, const std::vector<AttributeRange>& ranges) {
    std::vector<FrameAttribute> attributes;
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
        const MeshAttribute& attribute = mesh.attributes[a];
        attributes.push_back({attribute.name, attribute.type, attribute.components, {}});
        if (!ranges.empty()) attributes.back().range = ranges[a];
    }
    return attributes;
}

SurfacePart whole_of(const Mesh& mesh, const Statistics& statistics) {
    SurfacePart whole{.bricks = std::vector<std::uint32_t>(mesh.bricks.size()),
                      .ranges = attribute_ranges(mesh),
                      .spray = {mesh.spray.begin(), mesh.spray.end()},
                      .statistics = statistics};
    std::iota(whole.bricks.begin(), whole.bricks.end(), 0U);
    return whole;
}

}  // namespace

Mesh ReceivedFrame::mesh() const {
    std::vector<DecodedBrick> decoded;
    decoded.reserve(bricks.size());
    for (const auto& brick : bricks) decoded.push_back(decode_brick(*brick, offset_bits, coded_attributes));
    Mesh mesh = weld_bricks(decoded, cell_size, offset_bits);
    if (normals_by == NormalsBy::receiver) compute_normals(mesh);
    if (bricks.empty())
        for (const CodedAttribute& attribute : coded_attributes)
            mesh.attributes.push_back({attribute.name, attribute.type, attribute.components, {}});
    mesh.spray.assign(spray.begin(), spray.end());
    return mesh;
}

ReceivedFrame encode_frame(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
                           CodingOptions options) {
    return encode_part(mesh, whole_of(mesh, statistics), index, simulation_time, std::move(options));
}

ReceivedFrame encode_part(const Mesh& mesh, SurfacePart part, std::uint64_t index, double simulation_time,
                          CodingOptions options) {
    const auto start = std::chrono::steady_clock::now();
    ReceivedFrame frame;
    if (mesh.lattice.bricks.empty()) options.codec = Codec::draco;
    frame.index = index;
    frame.simulation_time = simulation_time;
    frame.cell_size = mesh.cell_size;
    frame.offset_bits = encoded_offset_bits(mesh, options);
    frame.spray = std::move(part.spray);
    frame.attributes = attributes_of(mesh, part.ranges);
    frame.coded_attributes = options.attributes;
    static_cast<Statistics&>(frame.statistics) = std::move(part.statistics);
    for (const std::uint32_t i : part.bricks) {
        const auto brick = std::make_shared<const EncodedBrick>(encode_brick(mesh, i, options));
        frame.statistics.encoded_bytes += brick->data.size() + brick->cell_levels.size();
        frame.bricks.push_back(brick);
    }
    frame.statistics.encode_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return frame;
}

ReceivedFrame encode_own(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
                         const BrickBox& own, CodingOptions options, std::span<const AttributeWish> wishes) {
    if (mesh.lattice.bricks.size() != mesh.bricks.size())
        throw InvalidInput("frame " + std::to_string(index) +
                           ": the mesh has no lattice, of which its bricks are made: reconstruct it with keep_lattice");
    SurfacePart part = own == all_bricks ? whole_of(mesh, statistics) : part_of(mesh, statistics, own);
    options.attributes = coded_attributes(mesh, part.ranges, wishes);
    return encode_part(mesh, std::move(part), index, simulation_time, std::move(options));
}

}  // namespace meniscus::client
