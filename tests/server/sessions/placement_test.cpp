#include "sessions/placement.hpp"

#include <gtest/gtest.h>

#include <array>

#include "sessions/refusal.hpp"

namespace meniscus::server {
namespace {

cuda::Device device(int index, std::size_t free_bytes) {
    return {.index = index, .name = {}, .capability = 90, .free_bytes = free_bytes, .total_bytes = 100};
}

TEST(Placement, TakesTheDeviceWithTheMostFreeMemory) {
    const std::array devices{device(0, 10), device(2, 30), device(3, 20)};
    const BackendOptions place = place_on({}, devices);
    EXPECT_EQ(place.backend, Backend::cuda);
    EXPECT_EQ(place.device, 2);
}

TEST(Placement, TakesTheFirstOfEqualDevices) {
    const std::array devices{device(1, 10), device(2, 10)};
    EXPECT_EQ(place_on({.backend = Backend::cuda}, devices).device, 1);
}

TEST(Placement, TakesTheCpuWithoutDevicesWhereItMay) {
    EXPECT_EQ(place_on({}, {}).backend, Backend::cpu);
    EXPECT_THROW(place_on({.backend = Backend::cuda}, {}), Refusal);
}

TEST(Placement, KeepsTheOtherOptions) {
    const std::array devices{device(0, 10)};
    const BackendOptions place = place_on({.threads = 3, .memory_limit = 4, .device_memory_limit = 5}, devices);
    EXPECT_EQ(place.threads, 3U);
    EXPECT_EQ(place.memory_limit, 4U);
    EXPECT_EQ(place.device_memory_limit, 5U);
}

}  // namespace
}  // namespace meniscus::server
