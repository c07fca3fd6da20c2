// Encoded frames for tests: made up, each brick's bytes its own version number.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "sessions/sending/begin_message.hpp"
#include "sessions/sending/encoded_frame.hpp"
#include "sessions/sending/place_order.hpp"

namespace meniscus::server::test {

struct InMeshOrder {
    bool operator()(const std::array<std::int32_t, 3>& a, const std::array<std::int32_t, 3>& b) const {
        return PlaceOrder(a) < PlaceOrder(b);
    }
};

/// Versions of bricks by place.
using Versions = std::map<std::array<std::int32_t, 3>, std::uint32_t, InMeshOrder>;

inline SharedMessage serialized(const v1::StreamResponse& response) {
    return std::make_shared<const std::string>(response.SerializeAsString());
}

/// A brick of `version` triangles, in as many parts.
inline SharedBrick made_brick(const std::array<std::int32_t, 3>& place, std::uint32_t version,
                              std::size_t padding = 0) {
    auto brick = std::make_shared<BrickMessages>();
    brick->place = place;
    brick->content_hash = {0, version};
    brick->triangles = version;
    for (std::uint32_t part = 0; part < 1 + version % 3; ++part) {
        v1::StreamResponse response;
        v1::MeshBrick& wire = *response.mutable_mesh_brick();
        wire.set_x(place[0]);
        wire.set_y(place[1]);
        wire.set_z(place[2]);
        wire.set_triangle_count(version);
        wire.set_data(std::to_string(version) + std::string(padding, '-'));
        wire.set_codec(v1::CODEC_DRACO);
        wire.set_part_index(part);
        wire.set_part_count(1 + version % 3);
        brick->messages.push_back(serialized(response));
        brick->bytes += brick->messages.back()->size();
    }
    return brick;
}

/// cell_size is such that bricks are unit cubes.
inline std::shared_ptr<EncodedFrame> made_frame(std::uint64_t index, const Versions& versions,
                                                std::size_t padding = 0) {
    auto frame = std::make_shared<EncodedFrame>();
    frame->index = index;
    frame->cell_size = 1.0 / 64.0;
    frame->offset_bits = 6;
    std::uint64_t triangles = 0;
    for (const auto& [place, version] : versions) {
        frame->bricks.push_back(made_brick(place, version, padding));
        triangles += version;
    }
    v1::StreamResponse begin = begin_response(*frame);
    begin.mutable_mesh_begin()->set_brick_count(static_cast<std::uint32_t>(versions.size()));
    begin.mutable_mesh_begin()->set_triangle_count(triangles);
    frame->begin = serialized(begin);
    v1::StreamResponse end;
    end.mutable_frame_statistics()->set_frame_index(index);
    frame->end = serialized(end);
    return frame;
}

}  // namespace meniscus::server::test
