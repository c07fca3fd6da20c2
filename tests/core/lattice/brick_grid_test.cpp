// The sparse grid against a sorted set of coordinates.
#include "lattice/brick_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "lattice/block_mask.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus {
namespace {

struct Order {
    bool operator()(const Int3& a, const Int3& b) const {
        const auto key = [](const Int3& c) { return std::pair{brick_key(brick_of(c)), index_in_brick(c)}; };
        return key(a) < key(b);
    }
};

TEST(BrickGrid, NumbersMembersFindsNeighborsAndRunsAsASortedSetDoes) {
    std::mt19937 random(2);
    std::uniform_int_distribution<int> place(-40, 40);
    std::map<Int3, std::uint32_t, Order> members;
    for (int i = 0; i < 6000; ++i) members[{place(random), place(random) / 2, place(random) / 3}] = 0;
    BrickGrid grid(std::make_shared<MemoryAccount>());
    std::uint32_t number = 0;
    for (auto& [c, n] : members) {
        n = number++;
        if (grid.bricks.empty() || !(grid.bricks.back().coordinate == brick_of(c))) {
            grid.bricks.emplace_back().clear();
            grid.bricks.back().coordinate = brick_of(c);
            grid.keys.push_back(brick_key(brick_of(c)));
        }
        grid.bricks.back().occupied[index_in_brick(c) >> 6] |= std::uint64_t{1} << (index_in_brick(c) & 63);
    }
    cpu::Workers workers(1);
    cpu::number_members(grid, workers);
    ASSERT_EQ(grid.members, members.size());
    const BrickGridView view = grid.view();
    for (const auto& [c, n] : members) {
        const std::uint32_t brick = view.find(brick_of(c));
        ASSERT_NE(brick, no_index);
        ASSERT_EQ(view.bricks[brick].number(index_in_brick(c)), n);
        for (int i = 0; i < 27; ++i) {
            const Int3 offset{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
            const auto other = members.find(c + offset);
            ASSERT_EQ(view.neighbor(brick, index_in_brick(c), offset),
                      other == members.end() ? no_index : other->second);
        }
    }
    BrickHints hints;
    for (int round = 0; round < 200; ++round) {
        const Int3 a{place(random), place(random), place(random)}, b{place(random), place(random), place(random)};
        const Int3 low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
            high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
        std::vector<std::uint32_t> found, expected;
        view.for_each_brick(low, high, hints, [&](const Brick& brick, const Int3& brick_low, const Int3& brick_high) {
            brick.for_each_run(brick_low, brick_high, [&](std::uint32_t first, std::uint32_t count) {
                for (std::uint32_t i = 0; i < count; ++i) found.push_back(first + i);
            });
        });
        for (const auto& [c, n] : members)
            if (c.x >= low.x && c.x <= high.x && c.y >= low.y && c.y <= high.y && c.z >= low.z && c.z <= high.z)
                expected.push_back(n);
        ASSERT_EQ(found, expected);
    }
}

TEST(BlockMask, ShiftingReadsTheValueSomePointsFurther) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 300; ++round) {
        const BlockMask own = random(), next = random();
        for (int axis = 0; axis < 3; ++axis)
            for (const int distance : {1, 2, 4}) {
                const BlockMask result = shifted(own, next, axis, distance);
                for (int bit = 0; bit < 64; ++bit) {
                    const int there = point_coordinate(bit, axis) + distance;
                    const int moved = bit + distance * bit_step(axis) - (there >= 4 ? 4 * bit_step(axis) : 0);
                    ASSERT_EQ(result >> bit & 1, (there >= 4 ? next : own) >> moved & 1);
                }
            }
    }
}

}  // namespace
}  // namespace meniscus
