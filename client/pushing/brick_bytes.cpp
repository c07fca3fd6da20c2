#include "pushing/brick_bytes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "files/brick_file_format.hpp"
#include "pushing/statistics_message.hpp"
#include "pushing/wire_message.hpp"

namespace meniscus::pushing {
namespace {

// Numbers of fields: proto/meniscus/v1/brick_file.proto, surface_service.proto, mesh.proto.
constexpr unsigned file_version = 1;
constexpr unsigned response_begin = 1, response_brick = 2, response_statistics = 3, response_spray = 6;
constexpr unsigned mesh_index = 1, mesh_time = 2, mesh_cell_size = 3, mesh_offset_bits = 4, mesh_brick_cells = 5,
                   mesh_bricks = 6, mesh_triangles = 9, mesh_spray = 11, mesh_attributes = 12;
constexpr unsigned attribute_name = 1, attribute_type = 2, attribute_components = 3, attribute_minimum = 4,
                   attribute_maximum = 5, attribute_bits = 6, attribute_coded_minimum = 7, attribute_coded_maximum = 8;
constexpr unsigned brick_x = 1, brick_y = 2, brick_z = 3, brick_vertices = 4, brick_triangles = 5, brick_data = 7,
                   brick_part = 8, brick_parts = 9, brick_codec = 10;
constexpr unsigned spray_positions = 1;
constexpr unsigned statistics_index = 1, statistics_time = 2;

constexpr std::size_t part_bytes = std::size_t{1} << 20;
constexpr std::size_t points_per_message = part_bytes / sizeof(Point);

Message described(const client::FrameAttribute& attribute, const CodedAttribute* coded) {
    const std::size_t count = attribute.components;
    Message message;
    message.text(attribute_name, attribute.name)
        .number(attribute_type, wire_type(attribute.type))
        .number(attribute_components, count);
    const auto pack = [&](unsigned field, const auto& numbers) {
        message.packed(field, std::span(numbers).first(count));
    };
    if (attribute.range) {
        pack(attribute_minimum, attribute.range->minimum);
        pack(attribute_maximum, attribute.range->maximum);
    }
    if (coded == nullptr) return message;
    message.present(attribute_bits, static_cast<std::uint64_t>(coded->bits));
    if (coded->bits == 0) return message;
    pack(attribute_coded_minimum, coded->minimum);
    pack(attribute_coded_maximum, coded->maximum);
    return message;
}

Message begin_message(const client::ReceivedFrame& frame) {
    std::uint64_t triangles = 0;
    for (const auto& brick : frame.bricks) triangles += brick->triangles;
    Message begin;
    begin.number(mesh_index, frame.index)
        .real(mesh_time, frame.simulation_time)
        .real(mesh_cell_size, frame.cell_size)
        .number(mesh_offset_bits, frame.offset_bits)
        .number(mesh_brick_cells, brick_cells)
        .number(mesh_bricks, frame.bricks.size())
        .number(mesh_triangles, triangles)
        .number(mesh_spray, frame.spray.size());
    for (const client::FrameAttribute& attribute : frame.attributes) {
        const auto coded = std::find_if(frame.coded_attributes.begin(), frame.coded_attributes.end(),
                                        [&](const CodedAttribute& c) { return c.name == attribute.name; });
        begin.message(mesh_attributes, described(attribute, coded == frame.coded_attributes.end() ? nullptr : &*coded));
    }
    return begin;
}

void append_brick(const EncodedBrick& brick, std::vector<FramePiece>& pieces) {
    const std::size_t parts = std::max<std::size_t>(1, (brick.data.size() + part_bytes - 1) / part_bytes);
    for (std::size_t part = 0; part < parts; ++part) {
        const auto rest = std::span(brick.data).subspan(part * part_bytes);
        const auto data = rest.first(std::min(part_bytes, rest.size()));
        Message message;
        message.signed_number(brick_x, brick.coordinate[0])
            .signed_number(brick_y, brick.coordinate[1])
            .signed_number(brick_z, brick.coordinate[2])
            .number(brick_vertices, brick.vertices)
            .number(brick_triangles, brick.triangles)
            .number(brick_part, part)
            .number(brick_parts, parts)
            .number(brick_codec, static_cast<std::uint64_t>(brick.codec))
            .length(brick_data, data.size());
        const std::size_t size = message.size() + data.size();
        const Message response = Message().length(response_brick, size);
        pieces.push_back({response.delimited(size) + message.bytes(), data});
    }
}

void append_spray(std::span<const Point> points, std::vector<FramePiece>& pieces) {
    for (; !points.empty(); points = points.subspan(std::min(points_per_message, points.size()))) {
        const auto data = std::as_bytes(points.first(std::min(points_per_message, points.size())));
        const Message spray = Message().length(spray_positions, data.size());
        const std::size_t size = spray.size() + data.size();
        const Message response = Message().length(response_spray, size);
        pieces.push_back({response.delimited(size) + spray.bytes(), data});
    }
}

}  // namespace

std::string bricks_beginning() {
    return std::string(files::brick_file_magic) + Message().number(file_version, files::brick_file_version).delimited();
}

std::vector<FramePiece> brick_pieces(const client::ReceivedFrame& frame) {
    std::vector<FramePiece> pieces;
    pieces.push_back({Message().message(response_begin, begin_message(frame)).delimited(), {}});
    for (const auto& brick : frame.bricks) append_brick(*brick, pieces);
    append_spray(frame.spray, pieces);
    Message statistics = statistics_message(frame.statistics);
    statistics.number(statistics_index, frame.index).real(statistics_time, frame.simulation_time);
    pieces.push_back({Message().message(response_statistics, statistics).delimited(), {}});
    return pieces;
}

}  // namespace meniscus::pushing
