// How much one caller may have of what all callers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "meniscus/described.hpp"

namespace meniscus::server {

/// The limits of one token's name, or without tokens of one peer address. 0 means no limit.
struct NameShares {
    std::uint32_t sessions = 0;
    std::uint32_t watchers = 0;           ///< of one session
    std::uint32_t formats = 0;            ///< of those watchers
    std::uint32_t frames_per_second = 0;  ///< over all sessions
    std::size_t bytes_in_flight = 0;      ///< over all sessions

    bool operator==(const NameShares&) const = default;
};

/// The limits that the tokens file gives to one name; the rest is as for everybody.
struct OwnShares {
    std::optional<std::uint32_t> sessions{};
    std::optional<std::uint32_t> watchers{};
    std::optional<std::uint32_t> frames_per_second{};
    std::optional<std::size_t> bytes_in_flight{};

    /// Calls visit(key, share, facts) for each, the key being that of the tokens file.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        visit("sessions", self.sessions, {});
        visit("watchers", self.watchers, {});
        visit("frames-per-second", self.frames_per_second, {});
        visit("bytes-in-flight", self.bytes_in_flight, {.unit = "bytes"});
    }

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
