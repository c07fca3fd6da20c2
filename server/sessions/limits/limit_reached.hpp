// A limit of the server that a request would pass, by its name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "meniscus/error.hpp"

namespace meniscus::server {

enum class LimitName : std::uint8_t {
    sessions,
    sessions_per_name,
    watchers,
    watchers_per_name,
    formats,
    formats_per_name,
    snapshots,
    snapshots_per_name,
    frames_per_second,
    frames_per_second_per_name,
    bytes_in_flight,
    bytes_in_flight_per_name,
    upload_time,
    answer_time,
    idle_time,
    recording_readers,
};
constexpr std::string_view name_of(LimitName limit) {
    switch (limit) {
        case LimitName::sessions:
            return "sessions";
        case LimitName::sessions_per_name:
            return "sessions_per_name";
        case LimitName::watchers:
            return "watchers";
        case LimitName::watchers_per_name:
            return "watchers_per_name";
        case LimitName::formats:
            return "formats";
        case LimitName::formats_per_name:
            return "formats_per_name";
        case LimitName::snapshots:
            return "snapshots";
        case LimitName::snapshots_per_name:
            return "snapshots_per_name";
        case LimitName::frames_per_second:
            return "frames_per_second";
        case LimitName::frames_per_second_per_name:
            return "frames_per_second_per_name";
        case LimitName::bytes_in_flight:
            return "bytes_in_flight";
        case LimitName::bytes_in_flight_per_name:
            return "bytes_in_flight_per_name";
        case LimitName::upload_time:
            return "upload_time";
        case LimitName::answer_time:
            return "answer_time";
        case LimitName::idle_time:
            return "idle_time";
        case LimitName::recording_readers:
            return "recording_readers";
    }
    return {};
}

/// For limits that callers share, so that it can be counted which one is too low, or which caller asks for too much.
class LimitReached : public LimitExceeded {
public:
    LimitReached(LimitName limit, const std::string& message) : LimitExceeded(message), limit_(limit) {}
    LimitName limit() const noexcept { return limit_; }

private:
    LimitName limit_;
};

}  // namespace meniscus::server
