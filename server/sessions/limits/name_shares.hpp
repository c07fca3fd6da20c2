// How much one caller may have of what all callers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace meniscus::server {

/// Of one token's name, or without tokens of one peer address. 0 means no limit.
struct NameShares {
    std::uint32_t sessions = 0;
    std::uint32_t watchers = 0;           ///< of one session
    std::uint32_t formats = 0;            ///< of those watchers
    std::uint32_t frames_per_second = 0;  ///< over all sessions
    std::size_t bytes_in_flight = 0;      ///< over all sessions

    bool operator==(const NameShares&) const = default;
};

/// What the tokens file says of one name; the rest is as for everybody.
struct OwnShares {
    std::optional<std::uint32_t> sessions{};
    std::optional<std::uint32_t> watchers{};
    std::optional<std::uint32_t> frames_per_second{};
    std::optional<std::size_t> bytes_in_flight{};

    NameShares over(const NameShares& everybody) const {
        return {.sessions = sessions.value_or(everybody.sessions),
                .watchers = watchers.value_or(everybody.watchers),
                .formats = everybody.formats,
                .frames_per_second = frames_per_second.value_or(everybody.frames_per_second),
                .bytes_in_flight = bytes_in_flight.value_or(everybody.bytes_in_flight)};
    }
    bool operator==(const OwnShares&) const = default;
};

}  // namespace meniscus::server
