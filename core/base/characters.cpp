// By hand, since core is built without Boost, too (MENISCUS_KERNEL_LAB).
#include "meniscus/characters.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace meniscus {
namespace {

struct Range {
    char32_t first;
    char32_t last;
};

constexpr std::array<Range, 14> controls{{
    {0x0000, 0x001F},    // controls
    {0x007F, 0x009F},    // controls
    {0x00AD, 0x00AD},    // soft hyphen
    {0x061C, 0x061C},    // Arabic letter mark
    {0x180E, 0x180E},    // Mongolian vowel separator
    {0x200B, 0x200B},    // zero width space
    {0x200E, 0x200F},    // marks of direction
    {0x2028, 0x202E},    // separators of lines and paragraphs, embeddings and overrides
    {0x2060, 0x206F},    // invisible operators, isolates, deprecated format characters
    {0xFE00, 0xFE0D},    // variation selectors, but those of emoji
    {0xFEFF, 0xFEFF},    // byte order mark
    {0xFFF9, 0xFFFB},    // annotations
    {0xE0000, 0xE007F},  // tags
    {0xE0100, 0xE01EF},  // variation selectors
}};

/// The rest of Unicode's Default_Ignorable_Code_Point (14.0, DerivedCoreProperties.txt), but for joiners and the
/// variation selectors of emoji, and of its format characters without ink.
constexpr std::array<Range, 13> fillers{{
    {0x034F, 0x034F},    // combining grapheme joiner
    {0x115F, 0x1160},    // Hangul fillers
    {0x17B4, 0x17B5},    // Khmer inherent vowels
    {0x180B, 0x180D},    // Mongolian variation selectors
    {0x180F, 0x180F},    // Mongolian variation selector
    {0x3164, 0x3164},    // Hangul filler
    {0xFFA0, 0xFFA0},    // Hangul filler
    {0xFFF0, 0xFFF8},    // not assigned
    {0x13430, 0x1343F},  // joiners of hieroglyphs
    {0x1BCA0, 0x1BCA3},  // shorthand format controls
    {0x1D173, 0x1D17A},  // musical format controls
    {0xE0080, 0xE00FF},  // not assigned
    {0xE01F0, 0xE0FFF},  // not assigned
}};

template <std::size_t N>
bool is_in(const std::array<Range, N>& ranges, char32_t c) {
    return std::any_of(ranges.begin(), ranges.end(),
                       [&](const Range& range) { return range.first <= c && c <= range.last; });
}

/// Of Unicode's 66 noncharacters: those at the end of each plane, and 32 among Arabic forms.
bool is_noncharacter(char32_t c) {
    return (c & 0xFFFEU) == 0xFFFE || (c >= 0xFDD0 && c <= 0xFDEF);
}

/// Bytes of the character that begins with this one; 0 if none does.
std::size_t length_of(unsigned lead) {
    if (lead < 0x80) return 1;
    if (lead < 0xC2) return 0;  // a byte from within a character, or the first of an overlong form
    if (lead < 0xE0) return 2;
    if (lead < 0xF0) return 3;
    return lead < 0xF5 ? 4 : 0;
}

}  // namespace

Character first_character(std::string_view text) {
    const Character no_character{text.substr(0, 1), std::nullopt};
    const unsigned lead = static_cast<unsigned char>(text.front());
    const std::size_t length = length_of(lead);
    if (length == 0 || text.size() < length) return no_character;
    if (length == 1) return {text.substr(0, 1), lead};
    char32_t code_point = lead & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        const unsigned byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xC0U) != 0x80) return no_character;
        code_point = code_point << 6 | (byte & 0x3FU);
    }
    constexpr std::array<char32_t, 5> least_of_length{0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code_point >= 0xD800 && code_point <= 0xDFFF;
    if (code_point < least_of_length.at(length) || code_point > 0x10FFFF || is_surrogate) return no_character;
    return {text.substr(0, length), code_point};
}

bool is_control(char32_t code_point) {
    return is_in(controls, code_point);
}

bool is_filler(char32_t code_point) {
    return is_in(fillers, code_point) || is_noncharacter(code_point);
}

}  // namespace meniscus
