#include "sessions/sending/brick_messages.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "conversion/brick_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/sending/place_order.hpp"

namespace meniscus::server {

SharedBrick brick_messages(const EncodedBrick& brick, const ContentHash& content_hash) {
    auto result = std::make_shared<BrickMessages>();
    result->place = brick.coordinate;
    result->content_hash = content_hash;
    result->triangles = brick.triangles;
    for (v1::MeshBrick& part : conversion::to_wire(brick)) {
        v1::StreamResponse response;
        *response.mutable_mesh_brick() = std::move(part);
        result->messages.push_back(std::make_shared<const std::string>(response.SerializeAsString()));
        result->bytes += result->messages.back()->size();
    }
    return result;
}

EncodedBrick encoded_brick(const BrickMessages& messages) {
    EncodedBrick brick;
    for (const SharedMessage& message : messages.messages) {
        v1::StreamResponse response;
        response.ParseFromString(*message);
        conversion::append_part(response.mesh_brick(), brick);
    }
    return brick;
}

SharedBrick find_brick(const std::vector<SharedBrick>& bricks, const std::array<std::int32_t, 3>& place) {
    const auto found = std::ranges::lower_bound(bricks, PlaceOrder(place), {},
                                                [](const SharedBrick& brick) { return PlaceOrder(brick->place); });
    return found != bricks.end() && (*found)->place == place ? *found : nullptr;
}

}  // namespace meniscus::server
