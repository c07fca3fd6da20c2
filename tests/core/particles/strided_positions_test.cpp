// Positions as programs have them, rounded to float32 once.
#include "meniscus/strided_positions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus {
namespace {

std::vector<float> copy_of(const StridedPositions& positions) {
    std::vector<float> result(3 * positions.count());
    positions.copy_to(result);
    return result;
}

template <class Make>
std::string refusal_to_copy(Make make) {
    try {
        copy_of(make());
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "accepted";
}

TEST(StridedPositions, RoundFloat64ToTheNearestFloat32) {
    const std::vector<double> numbers{0.1, 1.0 + 0x1p-24, 1.0 + 0x3p-24, -0x1.fffffefffffffp127, 0x1p-149, 0x0.8p-149};
    // A tie goes to the even neighbor; what is less than half a unit above the greatest float32 becomes that.
    const std::vector<float> nearest{0.1F, 1.0F, 1.0F + 0x1p-22F, -std::numeric_limits<float>::max(), 0x1p-149F, 0.0F};
    EXPECT_EQ(copy_of(std::span<const double>(numbers)), nearest);
}

TEST(StridedPositions, AreReadWhereverTheyLie) {
    const std::array<float, 6> positions{1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F};
    EXPECT_EQ(copy_of(std::span<const float>(positions)), std::vector<float>(positions.begin(), positions.end()));
    std::vector<char> memory(1 + 2 * 17);  // records of 17 bytes, which are not aligned
    for (std::size_t i = 0; i < 2; ++i) std::memcpy(&memory[1 + 17 * i], &positions[3 * i], 12);
    const StridedPositions unaligned(reinterpret_cast<const float*>(&memory[1]), 2, 17);
    EXPECT_EQ(copy_of(unaligned), std::vector<float>(positions.begin(), positions.end()));
}

TEST(StridedPositions, AreReadAxisByAxis) {
    constexpr std::size_t count = 1500;
    std::array<std::vector<double>, 3> axes;
    std::array<std::vector<float>, 3> narrow;
    std::vector<float> expected;
    for (std::size_t i = 0; i < 3 * count; ++i) {
        axes[i % 3].insert(axes[i % 3].end(), {1.0 / static_cast<double>(1 + i), std::nan("")});
        expected.push_back(static_cast<float>(axes[i % 3][2 * (i / 3)]));
        narrow[i % 3].push_back(expected.back());
    }
    EXPECT_EQ(copy_of({std::array<const double*, 3>{axes[0].data(), axes[1].data(), axes[2].data()}, count, 16}),
              expected);
    EXPECT_EQ(copy_of({std::array<const float*, 3>{narrow[0].data(), narrow[1].data(), narrow[2].data()}, count}),
              expected);
    axes[1][2 * 1234] = 1e39;
    const std::string said = refusal_to_copy([&] {
        return StridedPositions(std::array<const double*, 3>{axes[0].data(), axes[1].data(), axes[2].data()}, count,
                                16);
    });
    EXPECT_NE(said.find("particle 1234 has y = 1e+39"), std::string::npos) << said;
}

TEST(StridedPositions, AreRefusedWhereFloat32CannotHoldThem) {
    for (const double value : {0x1.ffffffp127, -0x1.ffffffp127, 1e300}) {
        const std::vector<double> numbers{0.0, 0.0, 0.0, 0.0, 0.0, value};
        const std::string said = refusal_to_copy([&] { return StridedPositions(numbers); });
        EXPECT_NE(said.find("particle 1 has z = "), std::string::npos) << said;
        EXPECT_NE(said.find("float32 cannot hold: at most 3.40282347e+38"), std::string::npos) << said;
    }
    for (const double value : {std::numeric_limits<double>::infinity(), std::nan("")}) {
        const std::vector<double> numbers{0.0, value, 0.0};
        const std::string said = refusal_to_copy([&] { return StridedPositions(numbers); });
        EXPECT_NE(said.find("particle 0 has y = "), std::string::npos) << said;
        EXPECT_NE(said.find("must be finite"), std::string::npos) << said;
        const std::vector<float> narrow{0.0F, static_cast<float>(value), 0.0F};
        EXPECT_EQ(refusal_to_copy([&] { return StridedPositions(narrow); }), said);
    }
}

TEST(StridedPositions, AreRefusedWhereTheirMemoryMakesNoSense) {
    const std::vector<double> numbers(7);
    EXPECT_EQ(refusal_to_copy([&] { return StridedPositions(numbers); }),
              "the frame has 7 coordinates, must be three per particle");
    EXPECT_EQ(refusal_to_copy([&] { return StridedPositions(numbers.data(), 2, 8); }),
              "the stride is 8 bytes, must be at least 24: three numbers of 8 bytes");
    EXPECT_NE(refusal_to_copy([] { return StridedPositions(static_cast<const float*>(nullptr), 3); }).find("no memory"),
              std::string::npos);
    EXPECT_EQ(refusal_to_copy([&] {
                  return StridedPositions(std::array<const double*, 3>{numbers.data(), nullptr, numbers.data()}, 2);
              }),
              "the frame has 2 particles, but no memory with their positions");
    EXPECT_EQ(
        refusal_to_copy([&] {
            return StridedPositions(std::array<const double*, 3>{numbers.data(), numbers.data(), numbers.data()}, 2, 4);
        }),
        "the stride is 4 bytes, must be at least 8: one number of 8 bytes");
    std::vector<float> room(5);
    EXPECT_THROW(StridedPositions(numbers.data(), 2).copy_to(room), InvalidInput);
}

}  // namespace
}  // namespace meniscus
