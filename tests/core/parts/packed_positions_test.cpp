// Positions that have been packed snap to the units that they snapped to, whatever they are, and take fewer bytes.
#include "parts/packed_positions.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "lattice/coordinates.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

std::vector<std::byte> packed(const std::vector<float>& positions, const std::vector<std::uint32_t>& places,
                              double units_per_length) {
    MessageWriter message;
    add_positions(message, positions, places, units_per_length);
    return message.take();
}

std::vector<float> unpacked(const std::vector<std::byte>& bytes) {
    MessageReader message(bytes);
    std::vector<float> positions{7.0F};  // they go behind what is there
    append_positions(message, positions);
    EXPECT_TRUE(message.is_at_end());
    EXPECT_EQ(positions.at(0), 7.0F);
    positions.erase(positions.begin());
    return positions;
}

void expect_same_units(const std::vector<float>& got, const std::vector<float>& expected, double units_per_length) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i)
        ASSERT_EQ(snap(got[i], units_per_length), snap(expected[i], units_per_length)) << i << ": " << expected[i];
}

TEST(PackedPositions, SnapToTheSameUnitsWhereverTheyAre) {
    std::mt19937 random(5);
    for (const double cell : {0.001, 0.0125, 0.1, 1.0 / 3.0, 1.0, 700.0})
        for (const double center : {0.0, 0.3, -20.0, 4e3, 1e6, 4e6})
            for (const double spread : {0.0, 1e-4, 1.0, 100.0, 1e5}) {
                // In cells; some are whole units and halves of them.
                std::uniform_real_distribution<double> place(center - spread, center + spread);
                std::vector<float> positions;
                for (int i = 0; i < 3 * 300; ++i) {
                    double at = place(random);
                    if (i % 7 == 0) at = std::floor(at * 8192.0) / 8192.0;
                    positions.push_back(static_cast<float>(at * cell));
                }
                const double units_per_length = units_per_cell / cell;
                expect_same_units(unpacked(packed(positions, {}, units_per_length)), positions, units_per_length);
            }
}

TEST(PackedPositions, SnapToTheSameUnitsOverAllOfSpace) {
    std::mt19937 random(6);
    std::uniform_int_distribution<std::uint32_t> bits;
    const double units_per_length = units_per_cell / 0.7;
    const double limit = static_cast<double>(max_cell) * 0.7;
    std::vector<float> positions;
    while (positions.size() < 3 * 5000) {
        const auto number = std::bit_cast<float>(bits(random));  // of any magnitude
        if (std::abs(number) <= limit) positions.push_back(number);
    }
    expect_same_units(unpacked(packed(positions, {}, units_per_length)), positions, units_per_length);
}

TEST(PackedPositions, AreThoseThatWereChosen) {
    std::vector<float> positions;
    positions.reserve(3 * 1000);
    for (int i = 0; i < 3 * 1000; ++i) positions.push_back(static_cast<float>(i));
    std::vector<std::uint32_t> places;
    std::vector<float> chosen;
    for (std::uint32_t i = 1; i < 1000; i += 3) {
        places.push_back(i);
        chosen.insert(chosen.end(), positions.begin() + 3 * i, positions.begin() + 3 * i + 3);
    }
    EXPECT_EQ(unpacked(packed(positions, places, 16.0)), chosen);
    EXPECT_TRUE(unpacked(packed({}, places, 16.0)).empty());
    EXPECT_TRUE(unpacked(packed({}, {}, 16.0)).empty());
}

TEST(PackedPositions, TakeAtMostThreeQuartersOfThoseThatLieTogether) {
    const double units_per_length = units_per_cell;  // cells of length 1, particles 4 apart
    std::mt19937 random(7);
    std::uniform_real_distribution<float> jitter(-0.5F, 0.5F);
    std::vector<float> rows;
    for (int i = 0; i < 40 * 40 * 200; ++i)
        for (const int at : {i % 200, i / 200 % 40, i / 8000})
            rows.push_back(4.0F * static_cast<float>(at) + jitter(random));
    const std::vector<std::byte> bytes = packed(rows, {}, units_per_length);
    EXPECT_LT(static_cast<double>(bytes.size()), 0.75 * static_cast<double>(rows.size() * sizeof(float)));
    expect_same_units(unpacked(bytes), rows, units_per_length);
}

TEST(PackedPositions, AreRefusedWhereTheirMessageEndsTooEarly) {
    std::vector<float> positions;
    positions.reserve(3 * 200);
    for (int i = 0; i < 3 * 200; ++i) positions.push_back(static_cast<float>(i % 50));
    const std::vector<std::byte> bytes = packed(positions, {}, 4096.0);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 20) {
        MessageReader message(std::span<const std::byte>(bytes).first(size));
        std::vector<float> got;
        EXPECT_THROW(append_positions(message, got), InvalidInput) << size;
    }
    std::vector<std::byte> wrong = bytes;
    const std::uint64_t many = std::uint64_t{1} << 60;
    std::memcpy(wrong.data(), &many, sizeof many);
    MessageReader message(wrong);
    std::vector<float> got;
    EXPECT_THROW(append_positions(message, got), InvalidInput);
}

}  // namespace
}  // namespace meniscus
