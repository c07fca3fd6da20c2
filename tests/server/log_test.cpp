#include "log.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

namespace meniscus::server {
namespace {

/// What is logged meanwhile by `call`.
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

}  // namespace
}  // namespace meniscus::server
