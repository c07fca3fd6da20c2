#include "process/log.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "process/call_log.hpp"

namespace meniscus::server {
namespace {

/// The lines that `call` logs.
template <class Call>
std::string logged(LogFormat format, const Call& call) {
    std::ostringstream out;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(out)));
    use_log_format(format);
    call();
    spdlog::set_default_logger(before);
    return out.str();
}

TEST(Log, NamesSessionAndFrameInText) {
    const std::string text = logged(LogFormat::text, [] {
        log_error({.session = "abc", .frame = 7}, "lost {}", 3);
        log_info({.session = "abc"}, "closed");
        spdlog::warn("of nothing");
    });
    EXPECT_NE(text.find(" error session abc, frame 7: lost 3\n"), std::string::npos) << text;
    EXPECT_NE(text.find(" info session abc: closed\n"), std::string::npos) << text;
    EXPECT_NE(text.find(" warning of nothing\n"), std::string::npos) << text;
}

TEST(Log, HasSessionAndFrameAsFieldsOfJson) {
    std::istringstream lines(logged(LogFormat::json, [] {
        log_error({.session = "abc", .frame = 7}, "lost \"{}\"\n\xff", 3);
        spdlog::warn("of nothing");
    }));
    std::string line;
    std::getline(lines, line);
    const nlohmann::json first = nlohmann::json::parse(line);
    EXPECT_EQ(first.at("level"), "error");
    EXPECT_EQ(first.at("session"), "abc");
    EXPECT_EQ(first.at("frame"), 7);
    EXPECT_EQ(first.at("message"), "lost \"3\"\n\xef\xbf\xbd") << "what is not UTF-8 is replaced";
    std::getline(lines, line);
    const nlohmann::json second = nlohmann::json::parse(line);
    EXPECT_EQ(second.at("message"), "of nothing");
    EXPECT_FALSE(second.contains("session"));
    EXPECT_FALSE(std::getline(lines, line));
}

TEST(CallLog, HasAllLinesOfSessionsInOrdinaryUse) {
    CallLog calls;
    const std::string text = logged(LogFormat::text, [&] {
        for (int session = 0; session < 200; ++session)
            for (const char* const what : {"created", "opened", "connected", "gone", "connected", "gone", "connected",
                                           "gone", "closed", "opened", "closed", "opened", "closed", "deleted"})
                calls.write({.session = "abc"}, "{}", what);
    });
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2800);
}

TEST(CallLog, HasThreeThousandLinesInTenSecondsAtTheMost) {
    CallLog calls;
    const std::string text = logged(LogFormat::text, [&] {
        for (int call = 0; call < 20'000; ++call) calls.write({.session = "abc"}, "stream from {} opened", "here");
    });
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_GE(lines, 3000);
    EXPECT_LE(lines, 6000) << "an interval may have ended meanwhile";
    EXPECT_NE(text.find(" info session abc: stream from here opened\n"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::server
