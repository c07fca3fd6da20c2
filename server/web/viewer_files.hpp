// The browser's viewer, as it was built into the program.
#pragma once

#include <span>
#include <string_view>

namespace meniscus::server {

struct ViewerFile {
    std::string_view path;  ///< as "/" or "/assets/index-1a2b3c.js"
    std::string_view content_type;
    bool hashed = false;      ///< whether the path changes with the content
    bool compressed = false;  ///< whether the bytes are gzip
    std::span<const unsigned char> bytes;
};

/// A page that explains, where the viewer was not built.
std::span<const ViewerFile> viewer_files();

}  // namespace meniscus::server
