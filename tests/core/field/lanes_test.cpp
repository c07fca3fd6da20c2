// Lanes round as scalars do: the same bits on every path rest on it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "field/lanes.hpp"
#include "support/float_bits.hpp"

namespace meniscus {
namespace {

constexpr std::size_t lane_count = WideLanes::count;

/// Numbers of every kind: of the field's size, any bits, zeros of both signs, some equal to their neighbors'.
struct Operands {
    float a[lane_count], b[lane_count], c[lane_count];

    explicit Operands(std::mt19937& random) {
        const auto number = [&] {
            std::uniform_real_distribution<float> of_the_field(-2.0F, 2.0F);
            switch (random() % 8) {
                case 0:
                    return test::float_of(static_cast<std::uint32_t>(random()));
                case 1:
                    return random() % 2 == 0 ? 0.0F : -0.0F;
                default:
                    return of_the_field(random);
            }
        };
        for (std::size_t i = 0; i < lane_count; ++i) {
            a[i] = number();
            b[i] = random() % 8 == 0 ? a[i] : number();
            c[i] = number();
        }
    }
};

void expect_same(const char* operation, const Operands& x, WideLanes lanes, float (*scalar)(float, float, float)) {
    float of_lanes[lane_count];
    lanes.store(of_lanes);
    for (std::size_t i = 0; i < lane_count; ++i) {
        const float expected = scalar(x.a[i], x.b[i], x.c[i]);
        if (std::isnan(expected) && std::isnan(of_lanes[i])) continue;
        ASSERT_EQ(test::bits_of(of_lanes[i]), test::bits_of(expected))
            << operation << " of " << x.a[i] << ", " << x.b[i] << ", " << x.c[i];
    }
}

TEST(Lanes, EveryOperationGivesTheScalarsBits) {
    std::mt19937 random(17);
    for (int round = 0; round < 20'000; ++round) {
        const Operands x(random);
        const WideLanes a = WideLanes::load(x.a), b = WideLanes::load(x.b), c = WideLanes::load(x.c);
        expect_same("+", x, a + b, [](float p, float q, float) { return p + q; });
        expect_same("-", x, a - b, [](float p, float q, float) { return p - q; });
        expect_same("*", x, a * b, [](float p, float q, float) { return p * q; });
        expect_same("/", x, a / b, [](float p, float q, float) { return p / q; });
        expect_same("fma", x, fma(a, b, c), [](float p, float q, float r) { return fma(p, q, r); });
        expect_same("fnma", x, fnma(a, b, c), [](float p, float q, float r) { return fnma(p, q, r); });
        expect_same("max", x, max(a, b), [](float p, float q, float) { return max(p, q); });
        expect_same("min", x, min(a, b), [](float p, float q, float) { return min(p, q); });
        expect_same("sqrt", x, sqrt(a), [](float p, float, float) { return sqrt(p); });
        expect_same("magnitude", x, magnitude(a), [](float p, float, float) { return magnitude(p); });
        expect_same("trunc", x, trunc(a), [](float p, float, float) { return trunc(p); });
        if (HasFatalFailure()) return;
    }
}

TEST(Lanes, SpansAreAddedToTheRowsOfASet) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(0.0F, 15.999F);
    for (int round = 0; round < 20'000; ++round) {
        float first[lane_count], last[lane_count];
        std::uint16_t rows[lane_count + 1], expected[lane_count + 1];
        const auto set = static_cast<unsigned>(random()) & ((1U << lane_count) - 1);
        for (std::size_t i = 0; i <= lane_count; ++i) expected[i] = rows[i] = static_cast<std::uint16_t>(random());
        for (std::size_t i = 0; i < lane_count; ++i) {
            const bool in_set = (set >> i & 1) != 0;
            first[i] = std::trunc(place(random));
            last[i] = std::trunc(place(random));
            if (in_set && first[i] > last[i]) std::swap(first[i], last[i]);
            for (int bit = 0; in_set && bit < 16; ++bit)
                if (static_cast<float>(bit) >= first[i] && static_cast<float>(bit) <= last[i])
                    expected[i] |= static_cast<std::uint16_t>(1U << bit);
        }
        add_spans(rows, WideLanes::load(first), WideLanes::load(last), set);
        for (std::size_t i = 0; i <= lane_count; ++i) ASSERT_EQ(rows[i], expected[i]) << "lane " << i;
    }
}

TEST(Lanes, ASetIsStoredInItsOrder) {
    std::mt19937 random(4);
    for (int round = 0; round < 20'000; ++round) {
        const Operands x(random);
        unsigned expected = 0;
        for (std::size_t i = 0; i < lane_count; ++i)
            if (x.a[i] <= x.b[i]) expected |= 1U << i;
        const unsigned set = less_equal(WideLanes::load(x.a), WideLanes::load(x.b));
        ASSERT_EQ(set, expected);
        float stored[lane_count];
        compress_store(stored, WideLanes::load(x.c), set);
        std::size_t next = 0;
        for (std::size_t i = 0; i < lane_count; ++i) {
            if ((set >> i & 1) == 0) continue;
            ASSERT_EQ(test::bits_of(stored[next++]), test::bits_of(x.c[i]));
        }
    }
}

TEST(Lanes, TheLeastAndTheGreatestAreFound) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> number(-100.0F, 100.0F);
    for (int round = 0; round < 1'000; ++round) {
        float x[lane_count];
        float least = 1e9F, greatest = -1e9F;
        for (float& v : x) {
            v = number(random);
            least = min(least, v);
            greatest = max(greatest, v);
        }
        ASSERT_EQ(reduce_min(WideLanes::load(x)), least);
        ASSERT_EQ(reduce_max(WideLanes::load(x)), greatest);
    }
}

}  // namespace
}  // namespace meniscus
