// Text of strangers, as it may stand in a message, a log or a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace meniscus {

/// Characters (code points) of a text that are shown; names of arrays and of sessions have no more.
inline constexpr std::size_t max_shown_characters = 64;

/// A line without quotes. What can be seen stays as it is; controls and what else cannot be seen become \u{XXXX}, bytes
/// that are not UTF-8 \xNN, a backslash \\. "..." follows if the text has more than `most` characters; none is cut.
std::string escaped(std::string_view text, std::size_t most = max_shown_characters);

/// Lines of our own with text of others in them, names of files for example: what cannot be seen is shown as escaped()
/// shows it, but for ends of lines. Backslashes stay.
std::string visible(std::string_view lines);

struct Quoted {
    std::string operator()(std::string_view text, char mark = '\'', std::size_t most = max_shown_characters) const;
};
/// The same between two marks; in the text, a backslash stands before a mark. An object, since the call of a function
/// could find std::quoted, which lets controls through.
inline constexpr Quoted quoted{};

}  // namespace meniscus
