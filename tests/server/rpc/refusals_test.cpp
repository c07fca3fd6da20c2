#include "rpc/calls/refusals.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <new>
#include <sstream>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {
namespace {

class CountedRefusals : public Metrics {
public:
    void refused(std::string_view reason, std::string_view name) override {
        ++counts[{std::string(reason), std::string(name)}];
    }
    std::map<std::pair<std::string, std::string>, int> counts;
};

struct RefusedCalls : testing::Test {
    RefusedCalls() {
        spdlog::set_default_logger(
            std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
    }
    ~RefusedCalls() override { spdlog::set_default_logger(before); }

    template <class Error>
    void report(const Error& error, const std::string& name = "ada") {
        refusals.report(std::make_exception_ptr(error), name, "ipv4:192.0.2.7:1");
    }
    std::ptrdiff_t lines() const {
        const std::string text = log.str();
        return std::count(text.begin(), text.end(), '\n');
    }

    const std::shared_ptr<spdlog::logger> before = spdlog::default_logger();
    std::ostringstream log;
    const std::shared_ptr<CountedRefusals> metrics = std::make_shared<CountedRefusals>();
    Refusals refusals{metrics};
};

TEST_F(RefusedCalls, AreCountedByReasonAndName) {
    report(LimitReached(LimitName::sessions_per_name, "too many"));
    report(LimitReached(LimitName::sessions_per_name, "too many"));
    report(LimitReached(LimitName::sessions_per_name, "too many"), "ben");
    report(IdleStream("idle"));
    report(LimitExceeded("too large"));
    report(std::bad_alloc());
    report(InvalidInput("wrong"));
    report(Refusal(Refusal::Kind::unauthenticated, "no token"), "");
    report(Refusal(Refusal::Kind::unavailable, "shutting down"));
    report(std::runtime_error("a defect"));
    refusals.report(nullptr, "ada", "");
    const std::map<std::pair<std::string, std::string>, int> expected{
        {{"sessions_per_name", "ada"}, 2}, {{"sessions_per_name", "ben"}, 1},
        {{"idle_time", "ada"}, 1},         {{"size", "ada"}, 2},
        {{"invalid_argument", "ada"}, 1},  {{"unauthenticated", ""}, 1}};
    EXPECT_EQ(metrics->counts, expected);
}

TEST_F(RefusedCalls, FillTheLogNoFasterThanTwentyLinesInTenSeconds) {
    report(InvalidInput("wrong"));
    EXPECT_EQ(lines(), 0) << "that is the client's own affair";
    for (int i = 0; i < 5000; ++i) report(LimitReached(LimitName::sessions, "too many"));
    EXPECT_GE(lines(), 20);
    EXPECT_LE(lines(), 40);
    EXPECT_NE(log.str().find("refused to ada at ipv4:192.0.2.7:1: too many"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::server
