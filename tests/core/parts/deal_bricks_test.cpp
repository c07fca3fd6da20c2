// Bricks are dealt to parts: each brick to one, and as much work to each as cuts between bricks allow.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "parts/brick_deal.hpp"
#include "support/parts.hpp"

namespace meniscus {
namespace {

std::vector<BrickLoad> random_loads(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int32_t> place(-6, 6);
    std::vector<BrickLoad> loads;
    loads.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        loads.push_back({{place(random), place(random), place(random)},
                         0,
                         static_cast<std::uint32_t>(random() % 100),
                         static_cast<std::uint32_t>(random() % 1000)});
    return loads;
}

std::uint64_t load_of(const BrickBox& box, const std::vector<BrickLoad>& loads) {
    std::uint64_t particles = 0;
    for (const BrickLoad& load : loads)
        if (box.holds(load.brick)) particles += load.particles;
    return particles;
}

TEST(DealBricks, GivesEachBrickToOnePart) {
    for (const int count : {0, 1, 2, 300})
        for (const std::size_t parts : {1U, 2U, 3U, 7U, 8U, 27U, 100U}) {
            const std::vector<BrickLoad> loads = random_loads(5, count);
            const std::vector<BrickBox> boxes = deal_bricks(loads, parts).boxes;
            ASSERT_LE(boxes.size(), parts);
            if (parts < 30) {
                ASSERT_EQ(boxes.size(), parts);
            }
            double volume = 0.0;
            for (const BrickBox& box : boxes) {
                double of_box = 1.0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    ASSERT_LT(box.low[axis], box.high[axis]);
                    of_box *= static_cast<double>(box.high[axis]) - box.low[axis];
                }
                volume += of_box;
            }
            EXPECT_EQ(volume, std::pow(2.0 * brick_end, 3));
            for (const BrickLoad& load : loads)
                EXPECT_EQ(
                    std::count_if(boxes.begin(), boxes.end(), [&](const BrickBox& b) { return b.holds(load.brick); }),
                    1);
        }
}

TEST(DealBricks, DoesNotDependOnTheOrderOfLoads) {
    std::vector<BrickLoad> loads = random_loads(6, 200);
    const std::vector<BrickBox> boxes = deal_bricks(loads, 9).boxes;
    for (unsigned seed = 0; seed < 5; ++seed) {
        std::shuffle(loads.begin(), loads.end(), std::mt19937(seed));
        EXPECT_EQ(deal_bricks(loads, 9).boxes, boxes);
    }
}

TEST(DealBricks, GivesPartsOfACubeTheSame) {
    std::vector<BrickLoad> loads;
    loads.reserve(8 * 8 * 8);
    for (std::int32_t i = 0; i < 8 * 8 * 8; ++i) loads.push_back({{i % 8, i / 8 % 8, i / 64}, 0, 10});
    for (const std::size_t parts : {2U, 4U, 8U, 64U})
        for (const BrickBox& box : deal_bricks(loads, parts).boxes) EXPECT_EQ(load_of(box, loads), 5120 / parts);
}

/// What the part with most work has, with that for the particles of bricks around it.
std::uint64_t most_work(const std::vector<BrickBox>& boxes, const std::vector<BrickLoad>& loads) {
    std::uint64_t most = 0;
    for (const BrickBox& box : boxes) {
        BrickBox wide = box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            wide.low[axis] = std::max(wide.low[axis] - 1, -brick_end);
            wide.high[axis] = std::min(wide.high[axis] + 1, brick_end);
        }
        std::uint64_t own = 0, beside = 0;
        for (const BrickLoad& load : loads) {
            if (box.holds(load.brick))
                own += load.work();
            else if (wide.holds(load.brick))
                beside += load.work_beside();
        }
        if (own != 0) most = std::max(most, own + beside);
    }
    return most;
}

/// Of all deals by cuts from face to face.
std::uint64_t least_most_work(const BrickBox& box, std::size_t parts, const std::vector<BrickLoad>& loads) {
    if (parts == 1) return most_work({box}, loads);
    std::uint64_t least = most_work({box}, loads);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::int32_t at = box.low[axis] + 1; at < box.high[axis]; ++at) {
            BrickBox low = box, high = box;
            low.high[axis] = high.low[axis] = at;
            for (std::size_t below = 1; below < parts; ++below)
                least = std::min(
                    least, std::max(least_most_work(low, below, loads), least_most_work(high, parts - below, loads)));
        }
    return least;
}

TEST(DealBricks, GivesThePartWithMostWorkNearlyTheLeastOfAllCuts) {
    std::mt19937 random(8);
    double dealt = 0.0, least = 0.0;
    for (int i = 0; i < 8; ++i) {
        std::vector<BrickLoad> loads;
        for (int b = 0; b < 12; ++b) {
            const auto place = [&random](unsigned edge) { return static_cast<std::int32_t>(random() % edge); };
            loads.push_back({{place(4), place(3), place(2)},
                             0,
                             static_cast<std::uint32_t>(random() % 1000),
                             static_cast<std::uint32_t>(random() % 5000)});
        }
        for (const std::size_t parts : {2U, 3U, 4U}) {
            const std::uint64_t best = least_most_work({{0, 0, 0}, {4, 3, 2}}, parts, loads);
            const std::uint64_t mine = most_work(deal_bricks(loads, parts).boxes, loads);
            EXPECT_GE(mine, best);
            if (parts == 2) {
                EXPECT_EQ(mine, best);
            }
            dealt += static_cast<double>(mine);
            least += static_cast<double>(best);
        }
    }
    EXPECT_LT(dealt, 1.02 * least);
}

TEST(DealBricks, GivesFewerParticlesToAPartWithManyTriangles) {
    // A row of water, of which the last bricks are drops: little water with much surface.
    std::vector<BrickLoad> loads;
    loads.reserve(12);
    for (std::int32_t x = 0; x < 12; ++x) loads.push_back({{x, 0, 0}, 0, x < 8 ? 1000U : 10U, x < 8 ? 0U : 14000U});
    const std::vector<BrickBox> boxes = deal_bricks(loads, 2).boxes;
    EXPECT_EQ(boxes[0].high[0], 8);
}

TEST(DealBricks, CutsWhereThereIsLittle) {
    // Two blocks of water, three bricks wide each, with a film between.
    std::vector<BrickLoad> loads;
    loads.reserve(9);
    for (std::int32_t x = 0; x < 9; ++x) loads.push_back({{x, 0, 0}, 0, x < 3 || x > 5 ? 1000U : 1U});
    const std::vector<BrickBox> boxes = deal_bricks(loads, 2).boxes;
    EXPECT_GT(boxes[0].high[0], 3);
    EXPECT_LT(boxes[0].high[0], 6);
}

TEST(DealBricks, FindsTheSameCutsFarApart) {
    // Few bricks a long way from each other, and the same places of many.
    std::vector<BrickLoad> far, near;
    for (std::int32_t i = 0; i < 8; ++i) {
        far.push_back({{1000 * i, 0, 0}, 0, 10});
        near.push_back({{i, 0, 0}, 0, 10});
    }
    for (const std::size_t parts : {2U, 4U, 8U})
        for (const std::vector<BrickLoad>* const loads : {&far, &near})
            for (const BrickBox& box : deal_bricks(*loads, parts).boxes) EXPECT_EQ(load_of(box, *loads), 80 / parts);
}

}  // namespace
}  // namespace meniscus
