#include "description/label.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "meniscus/characters.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::description {

namespace {

struct Range {
    char32_t first;
    char32_t last;
};

/// The characters that a label may have and that leave no ink.
constexpr std::array<Range, 8> blank{{
    {0x0020, 0x0020},
    {0x00A0, 0x00A0},
    {0x2000, 0x200D},  // spaces and joiners
    {0x202F, 0x202F},
    {0x205F, 0x205F},
    {0x2800, 0x2800},  // Braille pattern blank
    {0x3000, 0x3000},
    {0xFE0E, 0xFE0F},  // variation selectors of emoji
}};

bool is_blank(char32_t c) {
    return std::ranges::any_of(blank, [&](const Range& range) { return range.first <= c && c <= range.last; });
}

void require_label(std::string_view label, std::string_view what, std::size_t most) {
    if (label.empty()) return;
    const auto fail = [&](const std::string& why) {
        throw InvalidInput(std::string(what) + " is " + quoted(label, '"') + "; " + why);
    };
    const std::string rule = "it must be 1 to " + std::to_string(most) +
                             " characters of UTF-8, none of them a control, " + "a mark of direction or invisible";
    bool visible = false;
    for_each_character(label, [&](const Character& character) {
        const std::string_view bytes = character.bytes;
        if (!character.code_point) fail(rule + ", and has the byte " + escaped(bytes) + ", which is not UTF-8");
        const char32_t c = *character.code_point;
        if (is_control(c) || is_filler(c)) fail(rule + ", and has " + escaped(bytes));
        visible = visible || !is_blank(c);
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

std::size_t count_characters(std::string_view text) {
    std::size_t count = 0;
    for_each_character(text, [&](const Character&) { ++count; });
    return count;
}

std::string_view first_characters(std::string_view text, std::size_t most) {
    std::size_t count = 0;
    std::size_t size = 0;
    for_each_character(text, [&](const Character& character) {
        if (count++ < most) size += character.bytes.size();
    });
    return text.substr(0, size);
}

}  // namespace meniscus::description
