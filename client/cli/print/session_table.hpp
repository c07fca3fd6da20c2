// Sessions as a table for people.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"

namespace meniscus::cli {

struct SessionRow {
    client::SessionInfo session;
    std::optional<double> frames_per_second;  ///< not known before a session was seen twice
};

/// Frames per second of sessions, from their counts of frames at successive times.
class FrameRates {
public:
    std::vector<SessionRow> update(const std::vector<client::SessionInfo>& sessions,
                                   std::chrono::steady_clock::time_point now);

private:
    struct Seen {
        std::uint64_t frames = 0;
        std::chrono::steady_clock::time_point at;
    };
    std::map<std::string, Seen> seen_;  ///< by session
};

/// A header and a line for each row, each ended by a newline; without the column of frames per second where no row
/// knows them. now: for the sessions' ages.
std::string session_table(const std::vector<SessionRow>& rows,
                          std::chrono::system_clock::time_point now = std::chrono::system_clock::now());

/// With three digits and a suffix where there are more than four: "9999", "10.0k", "1.23M".
std::string short_count(std::uint64_t count);

}  // namespace meniscus::cli
