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
         {std::string("\0", 1), std::string("\n"), std::string("\x1b[2J"), std::string("\x7f"), std::string("\u0080"),
          std::string("\u009b"), std::string("\u061c"), std::string("\u200b"), std::string("\u200e"),
          std::string("\u200f"), std::string("\u2028"), std::string("\u2029"), std::string("\u202a"),
          std::string("\u202e"), std::string("\u2066"), std::string("\u2069"), std::string("\ufeff"),
          std::string("\U000E0041")}) {
        const std::string why = refusal("water" + bad + "fall");
        EXPECT_NE(why, "") << meniscus::escaped(bad);
        for (const unsigned char c : why) EXPECT_TRUE(c >= ' ' && c < 0x7f) << why;
    }
}

TEST(SessionName, IsUtf8) {
    for (const std::string bad : {"\xff", "\xc3", "\xc0\xaf" /* overlong */, "\xed\xa0\x80" /* a surrogate */,
                                  "\xed\xa0\xbd\xed\xb8\x80" /* a pair of them */, "\xf4\x90\x80\x80" /* too large */})
        EXPECT_NE(refusal("a" + bad).find("which is not UTF-8"), std::string::npos) << refusal("a" + bad);
}

TEST(SessionName, CanBeSeen) {
    for (const std::string blank : {" ", "   ", "\u00a0", "\u3000", "\u200d", "\u3164"})
        EXPECT_NE(refusal(blank).find("can be seen"), std::string::npos) << refusal(blank);
}

TEST(SessionName, IsCountedAndCutByCharacters) {
    EXPECT_EQ(count_characters("w\u00e4\U0001F30A\xff"), 4U);
    EXPECT_EQ(first_characters("w\u00e4\U0001F30A!", 3), "w\u00e4\U0001F30A");
    EXPECT_EQ(first_characters("ab", 3), "ab");
}

}  // namespace
}  // namespace meniscus::description
