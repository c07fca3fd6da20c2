// The viewer's files, embedded in the program that serves them.
#pragma once

#include <span>
#include <string_view>

namespace meniscus::viewer {

struct File {
    std::string_view path;  ///< as "/" or "/assets/index-1a2b3c.js"
    std::string_view content_type;
    bool hashed = false;      ///< whether the path changes with the content
    bool compressed = false;  ///< whether the bytes are gzip
    std::span<const unsigned char> bytes;
};

/// Where the viewer was not built: one page that says so.
std::span<const File> files();

}  // namespace meniscus::viewer
