// The tables of `meniscus sessions` and `meniscus top`.
#include "cli/print/session_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "cli/print/times.hpp"
#include "description/label.hpp"

namespace meniscus::test {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;

client::SessionInfo session(const std::string& id, std::uint64_t frames) {
    client::SessionInfo info;
    info.id = id;
    info.frames = frames;
    return info;
}

TEST(SessionTable, HasColumnsThatAlign) {
    const auto now = std::chrono::system_clock::now();
    client::SessionInfo busy = session("6a1f0a3c-5a37-4a39-b6ae-2f7f6b1f6d51", 123'456);
    busy.owner = "simulation-cluster";
    busy.description.name = "w\u00e4ter \u6c34";
    busy.created_at = now - std::chrono::minutes(12);
    busy.uploading = true;
    busy.settings.attributes = {"velocity", "age"};
    busy.watchers = 3;
    busy.frames_dropped = 17;
    busy.frames_skipped = 4;
    busy.last_frame.emplace();
    busy.last_frame->latency_seconds = 0.0123;
    busy.last_frame->particles = 1'000'000;
    client::SessionInfo waiting = session("new", 0);
    waiting.waits_for = client::SessionWait::device;
    client::SessionInfo of_an_admin = waiting;
    of_an_admin.waits_for_session = busy.id;
    client::SessionInfo full = waiting;
    full.waits_for = client::SessionWait::bytes_in_flight;
    full.settings.all_attributes = true;
    const std::string table = cli::session_table(
        {{busy, 59.94}, {waiting, std::nullopt}, {of_an_admin, std::nullopt}, {full, std::nullopt}}, now);
    std::istringstream lines(table);
    std::string header;
    std::getline(lines, header);
    for (std::string line; std::getline(lines, line);)
        EXPECT_EQ(description::count_characters(line), header.size()) << line;
    for (const char* word : {"w\u00e4ter \u6c34", "12 min", "simulation-cluster", "uploading", "velocity,age",
                             "  all  ", "123k", "59.9", "12.3", "1.00M", "17", "idle", "device: another session",
                             "device: 6a1f0a3c-5a37-4a39-b6ae-2f7f6b1f6d51", "bytes in flight"})
        EXPECT_NE(table.find(word), std::string::npos) << word << '\n' << table;
}

TEST(SessionTable, HasFramesPerSecondWhereTheyAreKnown) {
    const client::SessionInfo one = session("one", 7), two = session("two", 8);
    const auto now = std::chrono::system_clock::now();
    EXPECT_NE(cli::session_table({{one, 1.5}, {two, std::nullopt}}, now).find("FRAMES/S"), std::string::npos);
    const std::string table = cli::session_table({{one, std::nullopt}, {two, std::nullopt}}, now);
    EXPECT_EQ(table.find("FRAMES/S"), std::string::npos) << table;
    EXPECT_NE(table.find("FRAMES  LATENCY MS"), std::string::npos) << table;
}

TEST(SessionTable, IsOneLineForEachSessionWhateverItsNameIs) {
    client::SessionInfo hostile = session("new", 0);
    hostile.description.name = "a\nb\x1b[2J";  // from a server that lets it pass
    const std::string table = cli::session_table({{hostile, std::nullopt}});
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
    EXPECT_EQ(table.find('\x1b'), std::string::npos);
}

TEST(SessionTable, ShortensAges) {
    using namespace std::chrono_literals;
    EXPECT_EQ(cli::short_time(-5s), "0 s") << "the server's clock is ahead";
    EXPECT_EQ(cli::short_time(59s), "59 s");
    EXPECT_EQ(cli::short_time(60s), "1 min");
    EXPECT_EQ(cli::short_time(47h), "47 h");
    EXPECT_EQ(cli::short_time(48h), "2 d");
}

TEST(SessionTable, ShortensCountsWithoutPretendingTooMuch) {
    EXPECT_EQ(cli::short_count(0), "0");
    EXPECT_EQ(cli::short_count(9'999), "9999");
    EXPECT_EQ(cli::short_count(10'000), "10.0k");
    EXPECT_EQ(cli::short_count(99'949), "99.9k");
    EXPECT_EQ(cli::short_count(99'950), "100k");
    EXPECT_EQ(cli::short_count(999'499), "999k");
    EXPECT_EQ(cli::short_count(999'500), "1.00M");
    EXPECT_EQ(cli::short_count(1'234'567'890), "1.23G");
    EXPECT_EQ(cli::short_count(~std::uint64_t{0}), "18.4E");
}

TEST(FrameRates, AreTheFramesBetweenTwoLooks) {
    cli::FrameRates rates;
    const steady_clock::time_point start{};
    EXPECT_FALSE(rates.update({session("a", 100)}, start).front().frames_per_second);
    const auto rows = rates.update({session("a", 130), session("b", 7)}, start + seconds(2));
    EXPECT_DOUBLE_EQ(rows[0].frames_per_second.value(), 15.0);
    EXPECT_FALSE(rows[1].frames_per_second);
}

TEST(FrameRates, ForgetSessionsThatWentOrBeganAnew) {
    cli::FrameRates rates;
    const steady_clock::time_point start{};
    rates.update({session("a", 100), session("b", 100)}, start);
    EXPECT_FALSE(rates.update({session("a", 3)}, start + seconds(1)).front().frames_per_second);
    EXPECT_FALSE(rates.update({session("b", 200)}, start + seconds(2)).front().frames_per_second);
}

}  // namespace
}  // namespace meniscus::test
