#include "log_rate.hpp"

#include <gtest/gtest.h>

namespace meniscus::server {
namespace {

TEST(LogRates, LetABurstThroughAndThenSoManyASecond) {
    LogRate rate(2.0, 3.0);
    const LogRate::Clock::time_point start{};
    for (int i = 0; i < 3; ++i) EXPECT_EQ(rate.admit(start), std::optional<std::uint64_t>(0));
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(rate.admit(start));
    EXPECT_EQ(rate.admit(start + std::chrono::milliseconds(500)), std::optional<std::uint64_t>(100));
    EXPECT_FALSE(rate.admit(start + std::chrono::milliseconds(501)));
    EXPECT_EQ(rate.admit(start + std::chrono::hours(1)), std::optional<std::uint64_t>(1));
    int lines = 1;
    while (rate.admit(start + std::chrono::hours(1))) ++lines;
    EXPECT_EQ(lines, 3) << "the bucket holds no more than a burst";
}

}  // namespace
}  // namespace meniscus::server
