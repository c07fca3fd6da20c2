#include "sessions/session/placement.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "sessions/limits/refusal.hpp"

namespace meniscus::server {
namespace {

cuda::Device device(int index, std::size_t free_bytes) {
    return {.index = index, .name = {}, .capability = 90, .free_bytes = free_bytes, .total_bytes = 100};
}

bool all_answer(int) {
    return true;
}

TEST(Placement, TakesTheDeviceWithTheMostFreeMemory) {
    const std::vector devices{device(0, 10), device(2, 30), device(3, 20)};
    const BackendOptions place = place_on({}, devices, all_answer);
    EXPECT_EQ(place.backend, Backend::cuda);
    EXPECT_EQ(place.device, 2);
}

TEST(Placement, TakesTheFirstOfEqualDevices) {
    const std::vector devices{device(1, 10), device(2, 10)};
    EXPECT_EQ(place_on({.backend = Backend::cuda}, devices, all_answer).device, 1);
}

TEST(Placement, AsksNoDeviceButThoseThatItMayTake) {
    const std::vector devices{device(0, 10), device(2, 30), device(3, 20)};
    std::vector<int> asked;
    const BackendOptions place = place_on({}, devices, [&](int index) {
        asked.push_back(index);
        return index != 2;
    });
    EXPECT_EQ(place.device, 3);
    EXPECT_EQ(asked, (std::vector{2, 3}));
}

TEST(Placement, TakesTheCpuWhereNoDeviceAnswers) {
    const std::vector devices{device(0, 10), device(1, 20)};
    EXPECT_EQ(place_on({}, devices, [](int) { return false; }).backend, Backend::cpu);
    EXPECT_THROW(place_on({.backend = Backend::cuda}, devices, [](int) { return false; }), Refusal);
}

TEST(Placement, TakesTheCpuWithoutDevicesWhereItMay) {
    EXPECT_EQ(place_on({}, {}, all_answer).backend, Backend::cpu);
    EXPECT_THROW(place_on({.backend = Backend::cuda}, {}, all_answer), Refusal);
}

TEST(Placement, KeepsTheOtherOptions) {
    const std::vector devices{device(0, 10)};
    const BackendOptions place =
        place_on({.threads = 3, .memory_limit = 4, .device_memory_limit = 5}, devices, all_answer);
    EXPECT_EQ(place.threads, 3U);
    EXPECT_EQ(place.memory_limit, 4U);
    EXPECT_EQ(place.device_memory_limit, 5U);
}

}  // namespace
}  // namespace meniscus::server
