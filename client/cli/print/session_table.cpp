#include "cli/print/session_table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "cli/print/times.hpp"
#include "description/label.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::cli {
namespace {

constexpr std::size_t column_count = 16;
using Line = std::array<std::string, column_count>;

std::string fixed(double value, int digits) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*f", digits, value);
    return text.data();
}

const Line header{"SESSION",  "NAME",    "OWNER",    "STATE",      "WAITS FOR", "ATTRIBUTES",
                  "AGE",      "FRAMES",  "FRAMES/S", "LATENCY MS", "PARTICLES", "TRIANGLES",
                  "WATCHERS", "DROPPED", "SKIPPED",  "GPU BYTES"};

/// Columns of words; the others are numbers, and end where their column ends.
constexpr std::size_t words = 6;
constexpr std::size_t rates = 8;

std::string wait_of(const client::SessionInfo& session) {
    switch (session.waits_for) {
        case client::SessionWait::nothing:
            return "-";
        case client::SessionWait::device:
            return "device: " + (session.waits_for_session.empty() ? "another session" : session.waits_for_session);
        case client::SessionWait::bytes_in_flight:
            return "bytes in flight";
        case client::SessionWait::something_else:
            break;
    }
    return "?";
}

std::string attributes_of(const Settings& settings) {
    if (settings.all_attributes) return "all";
    std::string names;
    for (const std::string& name : settings.attributes) names += (names.empty() ? "" : ",") + escaped(name);
    return names.empty() ? "-" : names;
}

Line line_of(const SessionRow& row, std::chrono::system_clock::time_point now) {
    const client::SessionInfo& session = row.session;
    const std::string& name = session.description.name;
    const bool has_age = session.created_at != std::chrono::system_clock::time_point();  // an older server sends none
    Line line{session.id,
              name.empty() ? "-" : escaped(name),
              session.owner.empty() ? "-" : session.owner,
              session.uploading ? "uploading" : "idle",
              wait_of(session),
              attributes_of(session.settings),
              has_age ? short_time(now - session.created_at) : "-",
              short_count(session.frames)};
    line[rates] = row.frames_per_second ? fixed(*row.frames_per_second, 1) : "-";
    const auto& last = session.last_frame;
    line[9] = last ? fixed(last->latency_seconds * 1e3, 1) : "-";
    line[10] = last ? short_count(last->particles) : "-";
    line[11] = last ? short_count(last->triangles) : "-";
    line[12] = short_count(session.watchers);
    line[13] = short_count(session.frames_dropped);
    line[14] = short_count(session.frames_skipped);
    line[15] = last ? short_count(last->device_bytes) : "-";
    return line;
}

}  // namespace

std::vector<SessionRow> FrameRates::update(const std::vector<client::SessionInfo>& sessions,
                                           std::chrono::steady_clock::time_point now) {
    std::map<std::string, Seen> seen;
    std::vector<SessionRow> rows;
    for (const client::SessionInfo& session : sessions) {
        SessionRow row{.session = session, .frames_per_second = std::nullopt};
        const auto before = seen_.find(session.id);
        // A session that was deleted and created again has fewer frames than before.
        if (before != seen_.end() && now > before->second.at && session.frames >= before->second.frames)
            row.frames_per_second = static_cast<double>(session.frames - before->second.frames) /
                                    std::chrono::duration<double>(now - before->second.at).count();
        seen[session.id] = {.frames = session.frames, .at = now};
        rows.push_back(std::move(row));
    }
    seen_ = std::move(seen);
    return rows;
}

std::string session_table(const std::vector<SessionRow>& rows, std::chrono::system_clock::time_point now) {
    std::vector<Line> lines{header};
    for (const SessionRow& row : rows) lines.push_back(line_of(row, now));
    const bool has_rates =
        std::any_of(rows.begin(), rows.end(), [](const SessionRow& row) { return row.frames_per_second.has_value(); });
    std::array<std::size_t, column_count> widths{};
    for (const Line& line : lines)
        for (std::size_t i = 0; i < column_count; ++i)
            widths[i] = std::max(widths[i], description::count_characters(line[i]));
    std::string table;
    for (const Line& line : lines) {
        for (std::size_t i = 0; i < column_count; ++i) {
            if (i == rates && !has_rates) continue;
            const std::string padding(widths[i] - description::count_characters(line[i]), ' ');
            table += i < words ? line[i] + padding : padding + line[i];
            table += i + 1 < column_count ? "  " : "\n";
        }
    }
    return table;
}

std::string short_count(std::uint64_t count) {
    if (count < 10'000) return std::to_string(count);
    auto value = static_cast<double>(count);
    std::size_t suffix = 0;
    constexpr std::string_view suffixes = " kMGTPE";
    // 999.5 would be written as 1000.
    while (value >= 999.5 && suffix + 1 < suffixes.size()) {
        value /= 1000;
        ++suffix;
    }
    const int digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return fixed(value, digits) + suffixes[suffix];
}

}  // namespace meniscus::cli
