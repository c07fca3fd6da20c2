#include "growth.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "process_size.hpp"

namespace meniscus::soak {
namespace {

TEST(Growth, IsTheRiseOfAStraightLine) {
    EXPECT_DOUBLE_EQ(growth(std::vector{5.0, 7.0, 9.0, 11.0}), 6.0);
    EXPECT_DOUBLE_EQ(growth(std::vector{3.0, 3.0, 3.0}), 0.0);
    EXPECT_DOUBLE_EQ(growth(std::vector{4.0}), 0.0);
}

TEST(Growth, IsNotMovedByNoiseAtItsEnds) {
    std::vector<double> sizes(100, 10.0);
    sizes.back() = 20.0;
    EXPECT_LT(growth(sizes), 1.0);
}

TEST(ProcessSize, SeesMemoryAndDescriptorsThatAreHeld) {
    const ProcessSize before = process_size(::getpid());
    constexpr std::size_t bytes = std::size_t{32} << 20;
    const std::vector<char> memory(bytes, 'x');
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/dev/null", "r"), std::fclose);
    const ProcessSize after = process_size(::getpid());
    EXPECT_GE(after.memory_bytes, before.memory_bytes + bytes * 9 / 10);
    EXPECT_EQ(after.descriptors, before.descriptors + 1);
}

}  // namespace
}  // namespace meniscus::soak
