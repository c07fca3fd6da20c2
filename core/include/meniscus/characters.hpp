// The characters of a text in UTF-8, and those that are not text on a screen.
#pragma once

#include <optional>
#include <string_view>

namespace meniscus {

/// A character, or one byte that belongs to none: overlong forms and surrogates are no characters.
struct Character {
    std::string_view bytes;              ///< 1 to 4 of the text; 1 if they are no character
    std::optional<char32_t> code_point;  ///< none: not UTF-8
};

/// text: not empty.
Character first_character(std::string_view text);

/// Calls visit(character) for each.
template <class Visit>
void for_each_character(std::string_view text, const Visit& visit) {
    while (!text.empty()) {
        const Character character = first_character(text);
        visit(character);
        text.remove_prefix(character.bytes.size());
    }
}

/// Controls, ends of lines, marks that change the direction of writing, and format characters that cannot be seen.
/// Joiners and the variation selectors of emoji, which some scripts need, are none.
bool is_control(char32_t code_point);

/// Leaves no ink, and is neither a control, a space nor a joiner: a text with it looks like the text without it. So do
/// noncharacters, where they are not shown as a box.
bool is_filler(char32_t code_point);

}  // namespace meniscus
