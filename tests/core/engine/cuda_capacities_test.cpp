// The arithmetic of the CUDA backend's capacities, which needs no GPU.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/cuda/capacities.hpp"

namespace meniscus::cuda {
namespace {

using Needed = unsigned long long[resource_count];

TEST(CudaCapacities, BeginWithRoomForSomethingOfEverything) {
    Capacities capacities;
    EXPECT_TRUE(capacities.grow_to(0, Needed{}));
    EXPECT_GT(capacities.particles, 0U);
    for (const std::uint64_t capacity : capacities.of) EXPECT_GT(capacity, 0U);
}

TEST(CudaCapacities, WhatFitsDoesNotGrow) {
    Capacities capacities;
    const Needed needed{1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000, 9000, 10000};
    EXPECT_TRUE(capacities.grow_to(100000, needed));
    const Capacities before = capacities;
    EXPECT_FALSE(capacities.grow_to(100000, needed));
    EXPECT_FALSE(capacities.grow_to(110000, needed)) << "an eighth to spare";
    EXPECT_EQ(capacities.of, before.of);
}

TEST(CudaCapacities, OnlyWhatIsTooSmallGrowsAndNothingShrinks) {
    Capacities capacities;
    capacities.grow_to(1000, Needed{1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000});
    const Capacities before = capacities;
    Needed more{};
    more[static_cast<std::size_t>(Resource::samples)] = 1'000'000;
    EXPECT_TRUE(capacities.grow_to(10, more));
    EXPECT_EQ(capacities[Resource::samples], 1'125'000U);
    EXPECT_EQ(capacities.particles, before.particles);
    EXPECT_EQ(capacities[Resource::blocks], before[Resource::blocks]);
    EXPECT_EQ(capacities[Resource::triangles], before[Resource::triangles]);
}

TEST(CudaCapacities, CountsBeyond32BitsAreKept) {
    Capacities capacities;
    Needed needed{};
    needed[static_cast<std::size_t>(Resource::triangles)] = 10'000'000'000ULL;
    EXPECT_TRUE(capacities.grow_to(0, needed));
    EXPECT_EQ(capacities[Resource::triangles], 10'000'000'000ULL);
}

TEST(CudaCapacities, RoomToSpareEndsWhereNumbersDo) {
    Capacities capacities;
    Needed needed{};
    for (std::size_t r = 0; r < resource_count; ++r)
        needed[r] = std::min<std::uint64_t>(too_many(static_cast<Resource>(r)), no_index) - 1;
    EXPECT_TRUE(capacities.grow_to(0xFFFFFFF0ULL, needed));
    EXPECT_LT(capacities.particles, std::uint64_t{1} << 32);
    for (std::size_t r = 0; r < resource_count; ++r)
        if (too_many(static_cast<Resource>(r)) <= no_index) {
            EXPECT_LT(capacities.of[r], std::uint64_t{1} << 32);
        }
    EXPECT_LT(Brick::words * capacities[Resource::bricks], std::uint64_t{1} << 32) << "words are numbered too";
}

TEST(CudaCapacities, WholeKeysAreSortedWhereCellsAreFullOrBoxesAsLargeAsTheWorld) {
    Capacities capacities;
    Needed needed{};
    capacities.grow_to(1'000'000, needed);
    EXPECT_FALSE(capacities.orders_whole_keys());
    needed[static_cast<std::size_t>(Resource::boxed_bricks)] = std::uint64_t{1} << 50;
    capacities.grow_to(1'000'000, needed);
    EXPECT_FALSE(capacities.orders_whole_keys()) << "62 bits and an eighth more";
    Capacities far_apart = capacities;
    needed[static_cast<std::size_t>(Resource::boxed_bricks)] = std::uint64_t{1} << 51;
    far_apart.grow_to(1'000'000, needed);
    EXPECT_TRUE(far_apart.orders_whole_keys());
    Needed crowded{};
    crowded[static_cast<std::size_t>(Resource::cell_particles)] = Capacities::most_counted_in_cell + 1;
    capacities.grow_to(1'000'000, crowded);
    EXPECT_TRUE(capacities.orders_whole_keys());
}

TEST(CudaCapacities, EveryBlockGetsRoomForASampleAtOnce) {
    Capacities capacities;
    Needed needed{};
    needed[static_cast<std::size_t>(Resource::blocks)] = 100'000;
    EXPECT_TRUE(capacities.grow_to(0, needed));
    EXPECT_GE(capacities[Resource::samples], 100'000U);
}

}  // namespace
}  // namespace meniscus::cuda
