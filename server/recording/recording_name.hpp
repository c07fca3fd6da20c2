// How callers name a recording: never by a path.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace meniscus::server {

struct RecordingName {
    std::string session_id;
    std::uint32_t number = 0;
    auto operator<=>(const RecordingName&) const =
        default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here
};

}  // namespace meniscus::server
