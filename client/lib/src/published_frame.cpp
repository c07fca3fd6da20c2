#include "published_frame.hpp"

#include <google/protobuf/io/coded_stream.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "conversion/attribute_conversion.hpp"
#include "conversion/brick_conversion.hpp"
#include "conversion/spray_conversion.hpp"
#include "conversion/statistics_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {

namespace {

using google::protobuf::io::CodedOutputStream;

std::vector<v1::WatchResponse> messages_of(const ReceivedFrame& frame) {
    std::vector<v1::WatchResponse> messages;
    for (const auto& brick : frame.bricks)
        for (v1::MeshBrick& part : conversion::to_wire(*brick))
            *messages.emplace_back().mutable_mesh_brick() = std::move(part);
    for (v1::SprayPoints& points : conversion::to_wire(frame.spray))
        *messages.emplace_back().mutable_spray_points() = std::move(points);
    return messages;
}

void announce(const ReceivedFrame& frame, v1::MeshBegin& mesh) {
    mesh.set_frame_index(frame.index);
    mesh.set_simulation_time(frame.simulation_time);
    mesh.set_cell_size(frame.cell_size);
    mesh.set_offset_bits(frame.offset_bits);
    mesh.set_brick_cells(static_cast<std::uint32_t>(brick_cells));
    mesh.set_brick_count(static_cast<std::uint32_t>(frame.bricks.size()));
    std::uint64_t triangles = 0;
    for (const auto& brick : frame.bricks) triangles += brick->triangles;
    mesh.set_triangle_count(triangles);
    mesh.set_spray_count(frame.spray.size());
    for (const FrameAttribute& attribute : frame.attributes) {
        const auto coded = std::ranges::find(frame.coded_attributes, attribute.name, &CodedAttribute::name);
        // A part without bricks has no values.
        const bool has_range = attribute.range && !frame.bricks.empty();
        conversion::announce({attribute.name, attribute.type, attribute.components, {}},
                             has_range ? &*attribute.range : nullptr,
                             coded == frame.coded_attributes.end() ? nullptr : &*coded, mesh);
    }
}

}  // namespace

PushedFrame published_frame(const ReceivedFrame& frame, BytePool& pool) {
    if (!std::isfinite(frame.simulation_time))
        throw InvalidInput("frame " + std::to_string(frame.index) + ": simulation_time is " +
                           std::to_string(frame.simulation_time) + "; it must be finite");
    const std::vector<v1::WatchResponse> messages = messages_of(frame);
    std::size_t size = 0;
    for (const v1::WatchResponse& message : messages) {
        const std::size_t bytes = message.ByteSizeLong();
        size += bytes + CodedOutputStream::VarintSize32(static_cast<std::uint32_t>(bytes));
    }
    auto bytes = pool.take(size);
    auto* place = reinterpret_cast<std::uint8_t*>(bytes->data());
    for (const v1::WatchResponse& message : messages) {
        place = CodedOutputStream::WriteVarint32ToArray(static_cast<std::uint32_t>(message.GetCachedSize()), place);
        place = message.SerializeWithCachedSizesToArray(place);
    }
    v1::PublishRequest request;
    v1::PublishBegin& begin = *request.mutable_frame_begin();
    announce(frame, *begin.mutable_mesh());
    conversion::to_wire(frame.statistics, *begin.mutable_statistics());
    begin.set_byte_count(size);
    PushedFrame pushed{.index = frame.index, .begin = request.SerializeAsString(), .memory = nullptr, .parts = {}};
    pushed.parts.emplace_back(bytes->data(), bytes->size());
    pushed.memory = std::move(bytes);
    return pushed;
}

}  // namespace meniscus::client
