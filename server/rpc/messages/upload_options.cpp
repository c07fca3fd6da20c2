#include "rpc/messages/upload_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "conversion/attribute_conversion.hpp"
#include "meniscus/error.hpp"
#include "rpc/messages/normal_bits.hpp"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

namespace {

template <class Open>
UploadPolicy policy_of(const Open& message) {
    switch (message.policy()) {
        case v1::UPLOAD_POLICY_UNSPECIFIED:
        case v1::UPLOAD_POLICY_EVERY_FRAME:
            return UploadPolicy::every_frame;
        case v1::UPLOAD_POLICY_LATEST:
            return UploadPolicy::latest;
        case v1::UPLOAD_POLICY_EVERY_NTH:
            if (message.nth() == 0) throw InvalidInput("nth is 0; with UPLOAD_POLICY_EVERY_NTH it must be at least 1");
            return UploadPolicy::every_nth;
        case v1::UploadPolicy_INT_MIN_SENTINEL_DO_NOT_USE_:
        case v1::UploadPolicy_INT_MAX_SENTINEL_DO_NOT_USE_:
            break;
    }
    throw InvalidInput(
        fmt::format("policy has the value {}, which this version does not know", static_cast<int>(message.policy())));
}

template <class Open>
std::uint32_t parts_of(const Open& message) {
    const std::uint32_t parts = std::max(message.parts(), 1U);
    if (parts > parts_per_frame)
        throw InvalidInput(fmt::format("parts is {}; a frame has at most {}", message.parts(), parts_per_frame));
    if (message.part() >= parts)
        throw InvalidInput(fmt::format("part is {} of {} parts; they are counted from 0", message.part(), parts));
    if (parts > 1 && message.run_id() == 0)
        throw InvalidInput(fmt::format("run_id is 0, and parts is {}: all parts name the same run", parts));
    return parts;
}

template <class Open>
std::chrono::milliseconds reconnect_of(const Open& message) {
    const double seconds = message.reconnect_seconds();
    if (!std::isfinite(seconds) || seconds < 0.0)
        throw InvalidInput(fmt::format("reconnect_seconds is {}; it must be finite and at least 0", seconds));
    constexpr double as_good_as_for_ever = 1e9;  // so that the milliseconds can be counted
    return std::chrono::ceil<std::chrono::milliseconds>(
        std::chrono::duration<double>(std::min(seconds, as_good_as_for_ever)));
}

}  // namespace

UploadOptions upload_options(const v1::StreamOpen& message) {
    return {.receive_meshes = message.receive_meshes(),
            .normal_bits = normal_bits_of(message),
            .spray = message.with_spray(),
            .attributes = conversion::attribute_wishes(message.attributes()),
            .policy = policy_of(message),
            .nth = message.nth(),
            .run_id = message.run_id(),
            .parts = parts_of(message),
            .resumes = message.resumes(),
            .reconnect = reconnect_of(message)};
}

UploadOptions upload_options(const v1::PublishOpen& message) {
    return {.frames = FrameKind::bricks,
            .policy = policy_of(message),
            .nth = message.nth(),
            .run_id = message.run_id(),
            .parts = parts_of(message),
            .resumes = message.resumes(),
            .reconnect = reconnect_of(message)};
}

}  // namespace meniscus::server
