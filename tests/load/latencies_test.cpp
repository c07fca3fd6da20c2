#include "load/latencies.hpp"

#include <gtest/gtest.h>

namespace meniscus::load {
namespace {

TEST(Latencies, HaveExactPercentiles) {
    Latencies latencies;
    for (int i = 1000; i >= 1; --i) latencies.add(i);
    EXPECT_EQ(latencies.percentile(0.5), 500.0);
    EXPECT_EQ(latencies.percentile(0.99), 990.0);
    EXPECT_EQ(latencies.percentile(0.999), 999.0);
    EXPECT_EQ(latencies.percentile(1.0), 1000.0);
    EXPECT_EQ(latencies.mean(), 500.5);
}

TEST(Latencies, OfFewSamplesAreOneOfThem) {
    Latencies latencies;
    EXPECT_EQ(latencies.percentile(0.999), 0.0);
    latencies.add(3.0);
    EXPECT_EQ(latencies.percentile(0.0), 3.0);
    EXPECT_EQ(latencies.percentile(0.999), 3.0);
}

}  // namespace
}  // namespace meniscus::load
