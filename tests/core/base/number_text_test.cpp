// Decimal text of numbers: what std::to_chars() and std::from_chars() give, also where the C library stands in for
// them.
#include "meniscus/number_text.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

#include "base/number_text_by_locale.hpp"
#include "support/float_bits.hpp"

namespace meniscus {
namespace {

template <class Number>
std::string shortest(Number value) {
    std::string text;
    append_shortest(text, value);
    return text;
}

/// Any bits, and numbers of few digits.
template <class Number, class Bits>
std::vector<Number> numbers() {
    using Limits = std::numeric_limits<Number>;
    std::vector<Number> all{0,
                            -0.0F,
                            1,
                            -1,
                            10,
                            1e5F,
                            1e6F,
                            123456,
                            0.1F,
                            1e-4F,
                            1e-5F,
                            Limits::max(),
                            0.5F,
                            1e22F,
                            -7e9F,
                            3e-8F,
                            100,
                            1234,
                            2.5F,
                            Limits::min(),
                            Limits::denorm_min()};
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const auto bits = static_cast<Bits>(random());
        Number value;
        std::memcpy(&value, &bits, sizeof value);
        if (std::isfinite(value)) all.push_back(value);
        all.push_back(static_cast<Number>(static_cast<int>(random() % 20001) - 10000) / 1000);
    }
    return all;
}

/// May be one digit longer than the text that to_chars() gives, where a number is a power of two.
template <class Number>
void expect_shortest(Number value) {
    const std::string by_locale = by_locale::shortest(value);
    const std::string text = shortest(value);
    double read = 0.0;
    ASSERT_EQ(by_locale::read_number(text.data(), text.data() + text.size(), read).ptr, text.data() + text.size());
    EXPECT_EQ(static_cast<Number>(read), value) << text;
    EXPECT_EQ(std::signbit(read), std::signbit(value)) << text;
    int exponent = 0;
    if (std::abs(std::frexp(value, &exponent)) == Number{0.5})
        EXPECT_LE(by_locale.size(), text.size() + 1) << text;
    else
        EXPECT_EQ(by_locale, text);
}

TEST(NumberText, IsTheShortestThatReadsBackAsTheSameNumber) {
    for (const double value : numbers<double, std::uint64_t>()) expect_shortest(value);
    for (const float value : numbers<float, std::uint32_t>()) expect_shortest(value);
}

TEST(NumberText, NamesWhatIsNotFinite) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(by_locale::shortest(infinity), shortest(infinity));
    EXPECT_EQ(by_locale::shortest(-infinity), shortest(-infinity));
    EXPECT_EQ(by_locale::shortest(std::nan("")), shortest(std::nan("")));
}

TEST(NumberText, IsRoundedToDigits) {
    for (const double value : numbers<double, std::uint64_t>())
        for (const int digits : {2, 6})
            EXPECT_EQ(by_locale::printed("%.*g", digits, value), rounded_text(value, digits));
    EXPECT_EQ(rounded_text(0.0253999, 2), "0.025");
}

TEST(NumberText, IsReadAsFarAsItIsANumber) {
    for (const std::string_view text :
         {"1",   "-1.5",  ".5",     "5.",     "1e3",    "1e",   "1e+",  "0x10",     "0X1p3", "+1",
          " 1",  "",      "-",      ".",      "abc",    "inf",  "-inf", "infinity", "nan",   "-nan",
          "1,5", "1e400", "-1e400", "1e-400", "1e-310", "12ab", "1 2",  "n",        "i"}) {
        const char* const last = text.data() + text.size();
        double expected = 7.0, value = 7.0;
        const auto [end, error] = read_number(text.data(), last, expected);
        const auto found = by_locale::read_number(text.data(), last, value);
        EXPECT_EQ(found.ec, error) << text;
        EXPECT_EQ(found.ptr, end) << text;
        EXPECT_EQ(test::bits_of(value), test::bits_of(expected)) << text << ": " << value;
    }
}

TEST(NumberText, IsTheSameInALocaleWithCommas) {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
    EXPECT_EQ(by_locale::shortest(0.5), "0.5");
    EXPECT_EQ(rounded_text(0.5, 2), "0.5");
    constexpr std::string_view half = "0.5";
    double value = 0.0;
    EXPECT_EQ(by_locale::read_number(half.data(), half.data() + half.size(), value).ptr, half.data() + half.size());
    EXPECT_EQ(value, 0.5);
    std::setlocale(LC_NUMERIC, before.c_str());
}

}  // namespace
}  // namespace meniscus
