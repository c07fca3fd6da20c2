// Text that a client has sent, in a status: nothing in it is to end the text, or to move a terminal's cursor.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace meniscus::server {

/// Bytes that are not visible ASCII as \xNN, and a backslash as \\.
inline std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\\\";
        else if (c < ' ' || c > '~')
            out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out;
}

}  // namespace meniscus::server
