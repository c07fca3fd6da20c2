// The texts in a session's description: what may be one, and how long it is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace meniscus::description {

inline constexpr std::size_t max_name_characters = 64;
inline constexpr std::size_t max_unit_characters = 16;

/// Checks a label: it is empty, or UTF-8 of at most the above number of characters (code points), one of which can be
/// seen. Control characters, ends of lines, characters that change the direction of writing, and others that cannot be
/// seen are refused: nobody is to take one label for another, or for something else on the screen. Joiners, which some
/// scripts need, are allowed. Throws InvalidInput. what: the label's name in its message.
void require_name(std::string_view name, std::string_view what = "the session's name");
void require_length_unit(std::string_view unit, std::string_view what = "the session's unit of length");

/// The number of characters (code points) of a text; a byte that is not UTF-8 counts as one.
std::size_t count_characters(std::string_view text);
/// The first characters of a text, at most this number.
std::string_view first_characters(std::string_view text, std::size_t most);

}  // namespace meniscus::description
