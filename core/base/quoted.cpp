#include "meniscus/quoted.hpp"

#include <array>
#include <cstdio>

#include "meniscus/characters.hpp"

namespace meniscus {
namespace {

std::string formatted(const char* format, unsigned number) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return text.data();
}

std::string shown(const Character& character, char mark) {
    if (!character.code_point) return formatted("\\x%02x", static_cast<unsigned char>(character.bytes.front()));
    const char32_t c = *character.code_point;
    if (is_control(c) || is_filler(c)) return formatted("\\u{%04x}", c);
    const bool needs_backslash = c == U'\\' || (mark != '\0' && character.bytes.front() == mark);
    return std::string(needs_backslash ? "\\" : "").append(character.bytes);
}

/// mark: '\0' for none.
std::string line_of(std::string_view text, char mark, std::size_t most) {
    std::string line;
    for (; !text.empty() && most > 0; --most) {
        const Character character = first_character(text);
        line += shown(character, mark);
        text.remove_prefix(character.bytes.size());
    }
    return text.empty() ? line : line + "...";
}

}  // namespace

std::string escaped(std::string_view text, std::size_t most) {
    return line_of(text, '\0', most);
}

std::string visible(std::string_view lines) {
    std::string out;
    for_each_character(lines, [&](const Character& character) {
        const bool plain = character.bytes == "\n" || character.bytes == "\\";
        out += plain ? std::string(character.bytes) : shown(character, '\0');
    });
    return out;
}

std::string Quoted::operator()(std::string_view text, char mark, std::size_t most) const {
    return std::string(1, mark).append(line_of(text, mark, most)) + mark;
}

}  // namespace meniscus
