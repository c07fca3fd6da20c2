// The texts in a session's description: what may be one, and how long it is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace meniscus::description {

inline constexpr std::size_t max_name_characters = 64;
inline constexpr std::size_t max_unit_characters = 16;

/// Empty, or UTF-8 of at most so many characters (code points), one of which can be seen, without control characters,
/// ends of lines, characters that change the direction of writing, and others that cannot be seen: nobody is to take
/// one label for another, or for something else on the screen. Joiners, which some scripts need, are allowed. Throws
/// InvalidInput, which says what is wrong with `what`.
void require_name(std::string_view name, std::string_view what = "the session's name");
void require_length_unit(std::string_view unit, std::string_view what = "the session's unit of length");

/// Characters (code points) of it; a byte that is not UTF-8 counts as one.
std::size_t count_characters(std::string_view text);
/// As many of them, or all.
std::string_view first_characters(std::string_view text, std::size_t most);

}  // namespace meniscus::description
