#include "sessions/sending/spray_messages.hpp"

#include <memory>
#include <string>
#include <utility>

#include "conversion/spray_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

std::vector<SharedMessage> spray_messages(std::span<const Point> points) {
    std::vector<SharedMessage> messages;
    for (v1::SprayPoints& part : conversion::to_wire(points)) {
        v1::StreamResponse response;
        *response.mutable_spray_points() = std::move(part);
        messages.push_back(std::make_shared<const std::string>(response.SerializeAsString()));
    }
    return messages;
}

bool is_spray(std::string_view message) {
    // A message of a oneof is one field, which its tag begins: number and wire type.
    constexpr auto length_delimited = 2;
    constexpr auto tag = static_cast<char>(v1::WatchResponse::kSprayPointsFieldNumber << 3 | length_delimited);
    return !message.empty() && message.front() == tag;
}

}  // namespace meniscus::server
