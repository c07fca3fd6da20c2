// Seams are equal where both parts have found the same state around them, and differ for any difference.
#include <gtest/gtest.h>

#include "particles/seams.hpp"
#include "parts/contacts.hpp"
#include "steps/part_borders/part_borders.hpp"
#include "support/parts.hpp"

namespace meniscus {
namespace {

const std::vector<BrickBox> halves{{all_bricks.low, {0, brick_end, brick_end}},
                                   {{0, -brick_end, -brick_end}, all_bricks.high}};

/// The borders of both halves, which are made by themselves.
Borders borders_of_halves(const Settings& settings, const ParticleFrame& frame, std::uint32_t overlap) {
    Borders borders;
    for (std::size_t i = 0; i < halves.size(); ++i) {
        Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
        Mesh mesh;
        FramePart part;
        part.own = halves[i];
        part.overlap = overlap;
        const PartOutcome outcome = reconstructor.reconstruct_part(frame, part, mesh);
        borders.insert_or_assign(i, PartBorder(i, outcome.seams, mesh, halves));
    }
    return borders;
}

/// As one process that makes both.
ComparedContacts compared(const Borders& borders) {
    std::vector<PartExchange::Bytes> messages(1);
    write_contacts(borders, std::vector<std::size_t>{0, 0}, messages);
    return compare_contacts(borders, messages);
}

test::Particles water_around_the_origin(unsigned seed) {
    test::Particles particles = test::noise_cube(seed, 3000, 0.5, 0.025);
    for (float& coordinate : particles.positions) coordinate -= 0.45F;
    return particles;
}

TEST(Seams, AreEqualWhereBothPartsHaveSettledAlike) {
    const test::Particles particles = water_around_the_origin(3);
    const Borders borders = borders_of_halves(test::default_settings(), particles.frame(), 32);
    const std::vector<Seam>& seams = borders.at(0).touches.at(1).seams;
    ASSERT_GT(seams.size(), 4U);
    EXPECT_EQ(seams, borders.at(1).touches.at(0).seams);
    EXPECT_EQ(compared(borders).unequal.count, 0U);
    // Along the cut, diagonal neighbors too.
    for (const Seam& seam : seams) EXPECT_EQ(std::abs(seam.first[0] - seam.second[0]), 1);
}

TEST(Seams, DifferForAFlippedBitOfAHash) {
    const test::Particles particles = water_around_the_origin(4);
    Borders borders = borders_of_halves(test::default_settings(), particles.frame(), 32);
    for (const std::size_t half : {0U, 1U}) {
        std::vector<Seam>& seams = borders.at(half).touches.at(1 - half).seams;
        for (std::size_t i = 0; i < seams.size(); ++i) {
            const std::uint64_t bit = std::uint64_t{1} << (i % 64);
            seams[i].hash[i % 2] ^= bit;
            const ComparedContacts found = compared(borders);
            EXPECT_EQ(found.unequal.count, 1U);
            EXPECT_EQ(found.unequal.parts, (std::vector<std::size_t>{0, 1}));
            seams[i].hash[i % 2] ^= bit;
        }
    }
}

TEST(Seams, DifferWhereOnePartHasNone) {
    const test::Particles particles = water_around_the_origin(5);
    const Borders borders = borders_of_halves(test::default_settings(), particles.frame(), 32);
    for (const std::size_t half : {0U, 1U}) {
        const std::size_t seams = borders.at(half).touches.at(1 - half).seams.size();
        for (std::size_t i = 0; i < seams; ++i) {
            Borders less = borders;
            std::vector<Seam>& its = less.at(half).touches.at(1 - half).seams;
            its.erase(its.begin() + static_cast<std::ptrdiff_t>(i));
            EXPECT_EQ(compared(less).unequal.count, 1U) << half << " " << i;
            its.clear();
            EXPECT_EQ(compared(less).unequal.count, seams);
        }
    }
}

/// 2 x 2 x 2 bricks that store all their cells, of which the first is a part.
struct State {
    State() {
        for (int i = 0; i < 8; ++i) {
            Brick& brick = bricks[static_cast<std::size_t>(i)];
            brick.coordinate = {i & 1, i >> 1 & 1, i >> 2};
            for (std::uint64_t& word : brick.occupied) word = ~std::uint64_t{0};
            brick.first = static_cast<std::uint32_t>(i * brick_volume);
            brick.count();
            keys[static_cast<std::size_t>(i)] = brick_key(brick.coordinate);
        }
        std::mt19937 random(9);
        for (std::size_t b = 0; b < level.size(); ++b) {
            level[b] = static_cast<std::uint8_t>(1 + random() % 3);  // else a seam of two cells may be empty
            inside[b] = std::uint64_t{random()} << 32 | random();
            for (std::uint64_t& time : times[b].at) time = random() % 4;
        }
        blocks.grid = {bricks.data(), keys.data(), nullptr, 8};
        blocks.count = static_cast<std::uint32_t>(level.size());
        blocks.level = level.data();
        blocks.inside = inside.data();
        part.is_whole = false;
        part.own = {{0, 0, 0}, {brick_size, brick_size, brick_size}};
        part.settling = part.own.widened(4);
    }
    std::vector<Seam> seams() const {
        std::vector<WordHash> hashes(8 * neighbor_slots);
        for (std::uint32_t brick = 0; brick < 8; ++brick)
            for (int slot = 0; slot < neighbor_slots; ++slot) {
                if (!is_seam(part, bricks[brick].coordinate, slot)) continue;
                const FacingCells cells(slot);
                for (int i = 0; i < cells.count(); ++i)
                    add_cell_beside_seam(hashes[brick * neighbor_slots + static_cast<std::size_t>(slot)], blocks,
                                         times.data(), brick, cells.place(i), slot);
            }
        return seams_of(part, keys, hashes);
    }

    std::array<Brick, 8> bricks;
    std::array<std::uint64_t, 8> keys;
    std::vector<std::uint8_t> level = std::vector<std::uint8_t>(8 * brick_volume);
    std::vector<BlockMask> inside = std::vector<BlockMask>(8 * brick_volume);
    std::vector<RaiseTimes> times = std::vector<RaiseTimes>(8 * brick_volume);
    BlocksView blocks;
    LatticePart part;
};

// Of all cells: those that touch a cell of the other side, over faces, edges and corners, and no others.
TEST(Seams, DependOnTheCellsThatTouchTheOtherSideAndOnNoOthers) {
    State state;
    const std::vector<Seam> before = state.seams();
    ASSERT_EQ(before.size(), 26U);
    for (std::uint32_t block = 0; block < state.level.size(); block += 7) {
        const Brick& brick = state.bricks[block / brick_volume];
        const Int3 cell = brick.corner() + place_in_brick(static_cast<int>(block % brick_volume));
        const bool is_own = state.part.own.holds(cell);
        bool touches = false;
        for (int slot = 0; slot < neighbor_slots; ++slot)
            touches = touches || state.part.own.holds(cell + neighbor_offset(slot)) != is_own;
        for (int what = 0; what < 3; ++what) {
            const auto level = state.level[block];
            const auto inside = state.inside[block];
            const auto times = state.times[block];
            if (what == 0) state.level[block] = static_cast<std::uint8_t>((level + 1) % 4);
            if (what == 1) state.inside[block] ^= 1;  // its lowest corner, which every level has
            if (what == 2) state.times[block].at[block % 3] += 1;
            EXPECT_EQ(state.seams() != before, touches) << block << " " << what;
            state.level[block] = level;
            state.inside[block] = inside;
            state.times[block] = times;
        }
    }
}

}  // namespace
}  // namespace meniscus
