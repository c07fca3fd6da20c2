// The viewer's files, embedded in the programs that serve or write them.
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

/// The viewer as one page, as gzip: single_page.mjs says what is written into it. Empty where the viewer was not built.
std::span<const unsigned char> single_page();

/// The sources that the viewer's page may load: files of its own, some of which are WebAssembly.
inline constexpr std::string_view content_policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self'; "
    "connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; ";

}  // namespace meniscus::viewer
