#include "receiving/frame_messages.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "conversion/attribute_conversion.hpp"
#include "conversion/brick_conversion.hpp"
#include "conversion/spray_conversion.hpp"
#include "conversion/statistics_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {
namespace {

using Bricks = std::vector<std::shared_ptr<const EncodedBrick>>;

/// The most vanished bricks that an announcement names, so that it stays below 2 MB; as the server's.
constexpr std::size_t max_vanished = 65536;

auto order(const EncodedBrick& brick) {
    return std::tuple(brick.coordinate[2], brick.coordinate[1], brick.coordinate[0]);
}

bool are_equal(const EncodedBrick& a, const EncodedBrick& b) {
    return &a == &b || (a.codec == b.codec && a.vertices == b.vertices && a.triangles == b.triangles &&
                        a.cell_levels == b.cell_levels && a.data == b.data);
}

struct Difference {
    Bricks changed;
    std::vector<std::array<std::int32_t, 3>> vanished;
};

/// Both in the order of bricks.
Difference difference_of(const Bricks& bricks, const Bricks& base) {
    Difference difference;
    auto old = base.begin();
    for (const auto& brick : bricks) {
        for (; old != base.end() && order(**old) < order(*brick); ++old)
            difference.vanished.push_back((*old)->coordinate);
        const bool was_there = old != base.end() && (*old)->coordinate == brick->coordinate;
        if (!was_there || !are_equal(**old, *brick)) difference.changed.push_back(brick);
        if (was_there) ++old;
    }
    for (; old != base.end(); ++old) difference.vanished.push_back((*old)->coordinate);
    return difference;
}

/// Whether a brick of the base would be decoded to the same in the frame.
bool can_be_base(const ReceivedFrame* base, const ReceivedFrame& frame) {
    return base != nullptr && base->cell_size == frame.cell_size && base->offset_bits == frame.offset_bits &&
           base->coded_attributes == frame.coded_attributes;
}

v1::StreamResponse begin_message(const ReceivedFrame& frame, const Difference& difference, const ReceivedFrame* base) {
    v1::StreamResponse message;
    v1::MeshBegin& begin = *message.mutable_mesh_begin();
    begin.set_frame_index(frame.index);
    begin.set_simulation_time(frame.simulation_time);
    begin.set_cell_size(frame.cell_size);
    begin.set_offset_bits(frame.offset_bits);
    begin.set_brick_cells(brick_cells);
    begin.set_brick_count(static_cast<std::uint32_t>(difference.changed.size()));
    begin.set_run_id(frame.run_id);
    begin.set_spray_count(frame.spray.size());
    if (base != nullptr) begin.set_base_frame_index(base->index);
    for (const auto& place : difference.vanished) {
        v1::BrickPlace& wire = *begin.add_vanished();
        wire.set_x(place[0]);
        wire.set_y(place[1]);
        wire.set_z(place[2]);
    }
    for (const FrameAttribute& attribute : frame.attributes) {
        const auto coded = std::ranges::find(frame.coded_attributes, attribute.name, &CodedAttribute::name);
        conversion::announce({attribute.name, attribute.type, attribute.components, {}},
                             attribute.range ? &*attribute.range : nullptr,
                             coded == frame.coded_attributes.end() ? nullptr : &*coded, begin);
    }
    std::uint64_t triangles = 0;
    for (const auto& brick : frame.bricks) triangles += brick->triangles;
    begin.set_triangle_count(triangles);
    return message;
}

v1::StreamResponse statistics_message(const ReceivedFrame& frame) {
    v1::StreamResponse message;
    v1::FrameStatistics& out = *message.mutable_frame_statistics();
    conversion::to_wire(frame.statistics, out);
    out.set_frame_index(frame.index);
    out.set_simulation_time(frame.simulation_time);
    out.set_encode_seconds(frame.statistics.encode_seconds);
    out.set_latency_seconds(frame.statistics.latency_seconds);
    out.set_encoded_bytes(frame.statistics.encoded_bytes);
    return message;
}

}  // namespace

void give_messages(const ReceivedFrame& frame, const ReceivedFrame* base, const TakeMessage& take) {
    Difference difference;
    if (can_be_base(base, frame)) difference = difference_of(frame.bricks, base->bricks);
    if (!can_be_base(base, frame) || difference.changed.size() == frame.bricks.size() ||
        difference.vanished.size() > max_vanished) {
        base = nullptr;
        difference = {.changed = frame.bricks, .vanished = {}};
    }
    take(begin_message(frame, difference, base));
    for (const auto& brick : difference.changed)
        for (v1::MeshBrick& part : conversion::to_wire(*brick)) {
            v1::StreamResponse message;
            *message.mutable_mesh_brick() = std::move(part);
            take(message);
        }
    for (v1::SprayPoints& points : conversion::to_wire(frame.spray)) {
        v1::StreamResponse message;
        *message.mutable_spray_points() = std::move(points);
        take(message);
    }
    take(statistics_message(frame));
}

}  // namespace meniscus::client
