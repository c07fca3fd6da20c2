// Text of strangers: what is left of it in messages, logs and terminals.
#include "meniscus/quoted.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iomanip>  // std::quoted
#include <sstream>
#include <string>
#include <string_view>

#include "meniscus/characters.hpp"

namespace meniscus {
namespace {

using namespace std::string_literals;

std::string repeated(std::string_view text, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += text;
    return out;
}

/// Its UTF-8; that which a surrogate would have, too.
std::string encoded(char32_t c) {
    const auto byte = [](char32_t bits) { return static_cast<char>(static_cast<unsigned char>(bits)); };
    const auto next = [&](unsigned shift) { return byte(0x80 | ((c >> shift) & 0x3F)); };
    if (c < 0x80) return {byte(c)};
    if (c < 0x800) return {byte(0xC0 | (c >> 6)), next(0)};
    if (c < 0x10000) return {byte(0xE0 | (c >> 12)), next(6), next(0)};
    return {byte(0xF0 | (c >> 18)), next(12), next(6), next(0)};
}

struct QuotedCase {
    std::string text;
    std::string shown;
};

const QuotedCase quoted_cases[]{
    // As it is.
    {"", ""},
    {"velocity", "velocity"},
    {"dam break, 2nd try (50%)", "dam break, 2nd try (50%)"},
    {"w\u00e4ter \u6c34\u67f1 \u0645\u0648\u062c", "w\u00e4ter \u6c34\u67f1 \u0645\u0648\u062c"},
    {"\u0645\u06cc\u200c\u0631\u0648\u062f", "\u0645\u06cc\u200c\u0631\u0648\u062f"},  // a joiner that Persian needs
    {"\U0001F30A\uFE0F", "\U0001F30A\uFE0F"},
    // Controls: C0, DEL, C1.
    {"\0a"s, "\\u{0000}a"},
    {"a\nb\r\t", "a\\u{000a}b\\u{000d}\\u{0009}"},
    {"\x1b[2J\x7f", "\\u{001b}[2J\\u{007f}"},
    {"\xc2\x80\xc2\x9b\x33\xc2\x9f\xc2\xa1", "\\u{0080}\\u{009b}3\\u{009f}\u00a1"},
    // Marks of direction, characters that cannot be seen, ends of lines.
    {"gnp\u202egpj.exe", "gnp\\u{202e}gpj.exe"},
    {"\u2066a\u2069\u200e\u061c", "\\u{2066}a\\u{2069}\\u{200e}\\u{061c}"},
    {"wa\u200bter\ufeff\u00ad", "wa\\u{200b}ter\\u{feff}\\u{00ad}"},
    {"wa\u034fter\u3164\u2063", "wa\\u{034f}ter\\u{3164}\\u{2063}"},
    {"\u2028\u2029\u0085", "\\u{2028}\\u{2029}\\u{0085}"},
    {"\U000E0041", "\\u{e0041}"},
    // Bytes that are not UTF-8.
    {"\xff\xfe", "\\xff\\xfe"},
    {"a\x80\xbfz", "a\\x80\\xbfz"},
    {"\xc3", "\\xc3"},
    {"\xe2\x82z\xf0\x9f\x8c", "\\xe2\\x82z\\xf0\\x9f\\x8c"},
    {"\xc0\xaf\xc1\x81", "\\xc0\\xaf\\xc1\\x81"},                                      // overlong
    {"\xe0\x80\x8a\xf0\x80\x80\x8a", "\\xe0\\x80\\x8a\\xf0\\x80\\x80\\x8a"},           // overlong
    {"\xed\xa0\xbd\xed\xb8\x80", "\\xed\\xa0\\xbd\\xed\\xb8\\x80"},                    // surrogates
    {"\xf4\x90\x80\x80\xf8\x88\x80\x80", "\\xf4\\x90\\x80\\x80\\xf8\\x88\\x80\\x80"},  // beyond U+10FFFF
    // What looks like an escape is told from one.
    {"C:\\x1b", "C:\\\\x1b"},
    // Long ones.
    {std::string(64, 'a'), std::string(64, 'a')},
    {std::string(65, 'a'), std::string(64, 'a') + "..."},
    {std::string(63, 'a') + "\u00e4", std::string(63, 'a') + "\u00e4"},
    {std::string(63, 'a') + "\u00e4b", std::string(63, 'a') + "\u00e4..."},
    {repeated("\U0001F30A", 64), repeated("\U0001F30A", 64)},
    {repeated("\U0001F30A", 65), repeated("\U0001F30A", 64) + "..."},
    {std::string(1'000'000, '\n'), repeated("\\u{000a}", 64) + "..."},
    {std::string(63, 'a') + "\xf0\x9f\x8c", std::string(63, 'a') + "\\xf0..."},
};

TEST(TextOfStrangers, IsShownAsOneHarmlessLine) {
    for (const QuotedCase& each : quoted_cases) {
        EXPECT_EQ(escaped(each.text), each.shown);
        EXPECT_EQ(quoted(each.text), "'" + each.shown + "'");
        EXPECT_EQ(quoted(each.text, '"'), '"' + each.shown + '"');
    }
}

TEST(TextOfStrangers, CannotEndItsQuotes) {
    EXPECT_EQ(quoted("it's \"water\""), "'it\\'s \"water\"'");
    EXPECT_EQ(quoted("it's \"water\"", '"'), "\"it's \\\"water\\\"\"");
    EXPECT_EQ(quoted("\\'"), "'\\\\\\''");
    EXPECT_EQ(escaped("it's \"water\""), "it's \"water\"");
}

TEST(TextOfStrangers, IsAsLongAsAskedFor) {
    EXPECT_EQ(escaped("w\u00e4ter", 2), "w\u00e4...");
    EXPECT_EQ(escaped("w\u00e4ter", 5), "w\u00e4ter");
    EXPECT_EQ(quoted("w\u00e4ter", '"', 4), "\"w\u00e4te...\"");
    EXPECT_EQ(quoted("water", '\'', 0), "'...'");
    EXPECT_EQ(quoted("", '\'', 0), "''");
}

TEST(Visible, LinesStayButForWhatCannotBeSeen) {
    EXPECT_EQ(visible("a 'w\u00e4ter' \\u{001b}\nb\n"), "a 'w\u00e4ter' \\u{001b}\nb\n");
    EXPECT_EQ(visible("\x1b[31m\u202e\xff\t\r"), "\\u{001b}[31m\\u{202e}\\xff\\u{0009}\\u{000d}");
    EXPECT_EQ(visible(std::string(1000, 'a')), std::string(1000, 'a'));
}

TEST(TextOfStrangers, IsNotHandedToTheStandardLibrary) {
    const std::string text = "\x1b";
    std::ostringstream out;
    out << quoted(text);
    EXPECT_EQ(out.str(), "'\\u{001b}'");
}

TEST(TextOfStrangers, KeepsACodePointOrWritesItsNumber) {
    int kept = 0, numbered = 0, refused = 0;
    for (char32_t c = 0; c <= 0x10FFFF; ++c) {
        const std::string text = encoded(c), shown = escaped(text);
        if (c >= 0xD800 && c <= 0xDFFF) {
            ASSERT_EQ(shown.substr(0, 6), "\\xed\\x") << std::hex << std::uint32_t{c};
            ASSERT_EQ(shown.size(), 12U) << std::hex << std::uint32_t{c};
            ++refused;
        } else if (shown == text) {
            ASSERT_FALSE(is_control(c) || is_filler(c)) << std::hex << std::uint32_t{c};
            ++kept;
        } else if (c != U'\\') {
            ASSERT_EQ(shown.substr(0, 3), "\\u{") << std::hex << std::uint32_t{c};
            ASSERT_EQ(shown.back(), '}');
            ASSERT_EQ(std::stoul(shown.substr(3), nullptr, 16), c);
            ++numbered;
        }
        ASSERT_TRUE(std::ranges::none_of(shown, [](unsigned char byte) { return byte < 0x20 || byte == 0x7F; }));
    }
    EXPECT_EQ(refused, 0x800);
    EXPECT_EQ(numbered, 480 + 3776 + 66) << "controls, fillers and noncharacters";
    EXPECT_EQ(kept + numbered + refused + 1, 0x110000);
}

TEST(TextOfStrangers, IsReadByteForByte) {
    // Any two bytes after a letter: none is lost, none read twice.
    for (int first = 0; first < 256; ++first)
        for (int second = 0; second < 256; ++second) {
            const std::string text{'a', static_cast<char>(first), static_cast<char>(second)};
            std::string together;
            for_each_character(text, [&](const Character& character) {
                ASSERT_FALSE(character.bytes.empty());
                ASSERT_TRUE(character.code_point || character.bytes.size() == 1);
                together += character.bytes;
            });
            ASSERT_EQ(together, text);
        }
}

}  // namespace
}  // namespace meniscus
