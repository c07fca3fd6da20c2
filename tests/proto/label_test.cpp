// Names of sessions: what may be one, and how long it is.
#include "description/label.hpp"

#include <gtest/gtest.h>

#include <string>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::description {
namespace {

std::string repeated(const std::string& text, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += text;
    return out;
}

/// Of a character beyond ASCII.
std::string utf8(char32_t c) {
    const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
    const auto tail = [&](unsigned shift) { return byte(0x80 | (c >> shift & 0x3F)); };
    if (c < 0x800) return {byte(0xC0 | c >> 6), tail(0)};
    if (c < 0x10000) return {byte(0xE0 | c >> 12), tail(6), tail(0)};
    return {byte(0xF0 | c >> 18), tail(12), tail(6), tail(0)};
}

std::string refusal(const std::string& name) {
    try {
        require_name(name);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return {};
}

TEST(SessionName, MayBeAnyWordsOfAnyScript) {
    for (const std::string name :
         {"", "a", "dam break, 2nd try (50%)", "\u6c34\u67f1", "\u0645\u0648\u062c", "Gr\u00f6\u00dfe",
          "\u0645\u06cc\u200c\u0631\u0648\u062f" /* with a joiner that Persian needs */, "\U0001F30A\uFE0F",
          "a\\b \"c\""})
        EXPECT_EQ(refusal(name), "") << name;
}

TEST(SessionName, HasAtMost64CharactersHoweverManyBytesTheyAre) {
    EXPECT_EQ(refusal(repeated("\U0001F30A", 64)), "");
    EXPECT_NE(refusal(repeated("\U0001F30A", 65)).find("must be 1 to 64 characters"), std::string::npos);
    EXPECT_NE(refusal(repeated("\U0001F30A", 65)).find("and has 65"), std::string::npos);
    EXPECT_LT(refusal(std::string(1'000'000, 'a')).size(), 1000U);
    EXPECT_NO_THROW(require_length_unit("sixteen letters!"));
    EXPECT_THROW(require_length_unit("seventeen letters"), InvalidInput);
}

TEST(SessionName, HasNoControlsNorMarksOfDirectionNorOtherInvisibleCharacters) {
    for (const std::string& bad :
         {std::string("\0", 1),  std::string("\n"),         std::string("\x1b[2J"), std::string("\x7f"),
          std::string("\u0080"), std::string("\u009b"),     std::string("\u061c"),  std::string("\u200b"),
          std::string("\u200e"), std::string("\u200f"),     std::string("\u2028"),  std::string("\u2029"),
          std::string("\u202a"), std::string("\u202e"),     std::string("\u2066"),  std::string("\u2069"),
          std::string("\ufeff"), std::string("\U000E0041"), std::string("\u034f"),  std::string("\U0001D173"),
          std::string("\u1160"), std::string("\u3164"),     std::string("\uffa0"),  std::string("\ufdd0"),
          std::string("\ufffe"), std::string("\U0010ffff")}) {
        const std::string why = refusal("water" + bad + "fall");
        EXPECT_NE(why, "") << meniscus::escaped(bad);
        for (const unsigned char c : why) EXPECT_TRUE(c >= ' ' && c < 0x7f) << why;
    }
}

/// Unicode 14.0, DerivedCoreProperties.txt: Default_Ignorable_Code_Point.
TEST(SessionName, HasNoCharacterToIgnoreButJoinersAndEmojisSelectorsBesideOthers) {
    struct Range {
        char32_t first;
        char32_t last;
    };
    for (const Range range :
         {Range{0xAD, 0xAD}, Range{0x34F, 0x34F}, Range{0x61C, 0x61C}, Range{0x115F, 0x1160}, Range{0x17B4, 0x17B5},
          Range{0x180B, 0x180F}, Range{0x200B, 0x200F}, Range{0x202A, 0x202E}, Range{0x2060, 0x206F},
          Range{0x3164, 0x3164}, Range{0xFE00, 0xFE0F}, Range{0xFEFF, 0xFEFF}, Range{0xFFA0, 0xFFA0},
          Range{0xFFF0, 0xFFF8}, Range{0x1BCA0, 0x1BCA3}, Range{0x1D173, 0x1D17A}, Range{0xE0000, 0xE0FFF}})
        for (char32_t c = range.first; c <= range.last; ++c) {
            const std::string ignorable = utf8(c);
            const bool is_needed = c == 0x200C || c == 0x200D || c == 0xFE0E || c == 0xFE0F;
            ASSERT_EQ(refusal("water" + ignorable + "fall").empty(), is_needed) << meniscus::escaped(ignorable);
            ASSERT_NE(refusal(ignorable), "") << meniscus::escaped(ignorable);
        }
}

TEST(SessionName, IsUtf8) {
    for (const std::string bad : {"\xff", "\xc3", "\xc0\xaf" /* overlong */, "\xed\xa0\x80" /* a surrogate */,
                                  "\xed\xa0\xbd\xed\xb8\x80" /* a pair of them */, "\xf4\x90\x80\x80" /* too large */})
        EXPECT_NE(refusal("a" + bad).find("which is not UTF-8"), std::string::npos) << refusal("a" + bad);
}

TEST(SessionName, CanBeSeen) {
    for (const std::string blank : {" ", "   ", "\u00a0", "\u3000", "\u200d", "\ufe0f", "\u200d\ufe0e "})
        EXPECT_NE(refusal(blank).find("can be seen"), std::string::npos) << refusal(blank);
}

TEST(SessionName, IsCountedAndCutByCharacters) {
    EXPECT_EQ(count_characters("w\u00e4\U0001F30A\xff"), 4U);
    EXPECT_EQ(first_characters("w\u00e4\U0001F30A!", 3), "w\u00e4\U0001F30A");
    EXPECT_EQ(first_characters("ab", 3), "ab");
}

}  // namespace
}  // namespace meniscus::description
