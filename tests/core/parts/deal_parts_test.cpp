// Parts go to the processes that have most of their particles, and as many to each.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "parts/brick_deal.hpp"

namespace meniscus {
namespace {

std::vector<std::size_t> first_numbers(std::size_t count) {
    std::vector<std::size_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = i;
    return numbers;
}

TEST(DealParts, GivesEachRankTheBoxThatItHas) {
    std::vector<std::uint32_t> ranks{0, 1, 2, 3, 4, 5, 6, 7};
    for (unsigned seed = 0; seed < 5; ++seed) {
        std::shuffle(ranks.begin(), ranks.end(), std::mt19937(seed));
        // The octants of a cube, of which each rank has one and a little of the next one.
        std::vector<BrickLoad> loads;
        for (std::int32_t i = 0; i < 8 * 8 * 8; ++i) {
            const BrickCoordinate brick{i % 8, i / 8 % 8, i / 64};
            const auto octant = static_cast<std::size_t>(brick[0] / 4 + 2 * (brick[1] / 4) + 4 * (brick[2] / 4));
            loads.push_back({brick, ranks[octant], 90});
            loads.push_back({brick, ranks[(octant + 1) % 8], 10});
        }
        const BrickDeal deal = deal_bricks(loads, 8);
        const std::vector<std::size_t> rank_of = deal_parts(deal, first_numbers(8));
        for (std::size_t part = 0; part < 8; ++part) {
            std::map<std::size_t, std::uint64_t> particles;
            for (const BrickLoad& load : deal.loads_of(part)) {
                EXPECT_TRUE(deal.boxes[part].holds(load.brick));
                particles[load.rank] += load.particles;
            }
            EXPECT_EQ(particles[rank_of[part]], 64U * 90U) << part;
        }
    }
}

TEST(DealParts, GivesAsManyToEachMakerWhateverTheyHave) {
    std::mt19937 random(3);
    for (const std::size_t ranks : {1U, 2U, 5U, 16U})
        for (const std::size_t parts : {1U, 4U, 16U, 23U})
            for (const bool are_there_particles : {true, false}) {
                std::vector<BrickLoad> loads;
                for (int i = 0; are_there_particles && i < 500; ++i) {
                    const auto place = [&] { return static_cast<std::int32_t>(random() % 20); };
                    // Most of them on few ranks.
                    const auto rank = static_cast<std::uint32_t>(random() % (1 + random() % ranks));
                    loads.push_back({{place(), place(), place()}, rank, static_cast<std::uint32_t>(random() % 50), 7});
                }
                const BrickDeal deal = deal_bricks(loads, parts);
                std::map<std::size_t, std::size_t> parts_of;
                for (const std::size_t rank : deal_parts(deal, first_numbers(ranks))) ++parts_of[rank];
                for (std::size_t rank = 0; rank < ranks; ++rank) {
                    EXPECT_GE(parts_of[rank], parts / ranks);
                    EXPECT_LE(parts_of[rank], (parts + ranks - 1) / ranks);
                }
                EXPECT_EQ(parts_of.size(), ranks);
            }
}

TEST(DealParts, CountsRanksWithoutPartsToTheMakerBeforeThem) {
    std::vector<BrickLoad> loads;
    loads.reserve(8);
    for (std::int32_t x = 0; x < 8; ++x) loads.push_back({{x, 0, 0}, static_cast<std::uint32_t>(7 - x), 10});
    const std::vector<std::size_t> makers{1, 5};
    EXPECT_EQ(deal_parts(deal_bricks(loads, 2), makers), (std::vector<std::size_t>{5, 1}));
}

}  // namespace
}  // namespace meniscus
