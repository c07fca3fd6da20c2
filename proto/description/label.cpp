#include "description/label.hpp"

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>
#include <cstdint>
#include <cstdio>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus::description {

namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;
using boost::locale::utf::code_point;

struct Range {
    code_point first;
    code_point last;
    bool holds(code_point c) const { return first <= c && c <= last; }
};

/// What no label has, in Unicode's order.
constexpr std::array<Range, 14> forbidden{{
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

/// What leaves no ink, of what a label may have.
constexpr std::array<Range, 9> blank{{
    {0x0020, 0x0020},
    {0x00A0, 0x00A0},
    {0x115F, 0x1160},  // Hangul fillers
    {0x2000, 0x200D},  // spaces and joiners
    {0x202F, 0x202F},
    {0x205F, 0x205F},
    {0x2800, 0x2800},  // Braille pattern blank
    {0x3000, 0x3000},
    {0x3164, 0x3164},  // Hangul filler
}};

template <std::size_t N>
bool is_in(const std::array<Range, N>& ranges, code_point c) {
    return std::any_of(ranges.begin(), ranges.end(), [&](const Range& range) { return range.holds(c); });
}

bool is_character(code_point c) {
    return c != boost::locale::utf::illegal && c != boost::locale::utf::incomplete;
}

/// Calls visit(character, bytes) for each; an illegal byte is one of no character.
template <class Visit>
void for_each_character(std::string_view text, const Visit& visit) {
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        const char* next = at;
        const code_point c = Utf8::decode(next, end);
        if (!is_character(c)) next = at + 1;
        visit(c, std::string_view(at, static_cast<std::size_t>(next - at)));
        at = next;
    }
}

template <class Number>
std::string formatted(const char* format, Number number) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return text.data();
}

void require_label(std::string_view label, std::string_view what, std::size_t most) {
    if (label.empty()) return;
    constexpr std::size_t most_bytes = 4;  // of a character
    const auto fail = [&](const std::string& why) {
        const bool cut = label.size() > most * most_bytes;
        throw InvalidInput(std::string(what) + " is \"" + escaped(label.substr(0, most * most_bytes)) +
                           (cut ? "\"...; " : "\"; ") + why);
    };
    const std::string rule = "it must be 1 to " + std::to_string(most) +
                             " characters of UTF-8, none of them a control, " + "a mark of direction or invisible";
    bool visible = false;
    for_each_character(label, [&](code_point c, std::string_view bytes) {
        if (!is_character(c)) fail(rule + ", and has the byte " + escaped(bytes) + ", which is not UTF-8");
        if (is_in(forbidden, c)) fail(rule + ", and has " + escaped(bytes));
        visible = visible || !is_in(blank, c);
    });
    const std::size_t count = count_characters(label);
    if (count > most) fail(rule + ", and has " + std::to_string(count));
    if (!visible) fail("it must have a character that can be seen");
}

}  // namespace

void require_name(std::string_view name, std::string_view what) {
    require_label(name, what, max_name_characters);
}

void require_length_unit(std::string_view unit, std::string_view what) {
    require_label(unit, what, max_unit_characters);
}

std::string escaped(std::string_view text) {
    std::string out;
    for_each_character(text, [&](code_point c, std::string_view bytes) {
        if (!is_character(c))
            out += formatted("\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(bytes.front())));
        else if (is_in(forbidden, c))
            out += formatted("\\u{%04x}", static_cast<unsigned>(c));
        else if (c == '\\' || c == '"')
            (out += '\\') += bytes;
        else
            out += bytes;
    });
    return out;
}

std::string quoted(std::string_view text) {
    std::string out(1, '"');
    out += escaped(text);
    out += '"';
    return out;
}

std::size_t count_characters(std::string_view text) {
    std::size_t count = 0;
    for_each_character(text, [&](code_point, std::string_view) { ++count; });
    return count;
}

std::string_view first_characters(std::string_view text, std::size_t most) {
    std::size_t count = 0;
    std::size_t size = 0;
    for_each_character(text, [&](code_point, std::string_view bytes) {
        if (count++ < most) size += bytes.size();
    });
    return text.substr(0, size);
}

}  // namespace meniscus::description
