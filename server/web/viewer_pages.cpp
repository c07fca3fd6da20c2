#include "web/viewer_pages.hpp"

#include <zlib.h>

#include <array>
#include <stdexcept>
#include <string>

#include "web/viewer_files.hpp"

namespace meniscus::server {

namespace {

/// The viewer is of files of its own, one of which is WebAssembly.
constexpr const char* policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self'; "
    "connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string inflated(std::span<const unsigned char> gzip) {
    z_stream stream{};
    constexpr int gzip_window = 15 + 16;
    if (inflateInit2(&stream, gzip_window) != Z_OK) throw std::runtime_error("zlib could not start");
    stream.next_in = const_cast<unsigned char*>(gzip.data());
    stream.avail_in = static_cast<unsigned>(gzip.size());
    std::string text;
    std::array<unsigned char, 16384> part{};
    int result = Z_OK;
    while (result == Z_OK) {
        stream.next_out = part.data();
        stream.avail_out = part.size();
        result = inflate(&stream, Z_NO_FLUSH);
        text.append(reinterpret_cast<const char*>(part.data()), part.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (result != Z_STREAM_END) throw std::runtime_error("a file of the viewer is damaged");
    return text;
}

Page page_of(const ViewerFile& file, std::string_view accept_encoding) {
    Page page{.content_type = std::string(file.content_type),
              .cache_control = file.hashed ? "public, max-age=31536000, immutable" : "no-cache",
              .headers = {{"Vary", "Accept-Encoding"}, {"Content-Security-Policy", policy}, {"Referrer-Policy", "no-referrer"}}};
    const bool as_it_is = !file.compressed || accept_encoding.find("gzip") != std::string_view::npos;
    if (!as_it_is) {
        page.body = inflated(file.bytes);
        return page;
    }
    if (file.compressed) page.headers.emplace_back("Content-Encoding", "gzip");
    page.body.assign(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
    return page;
}

}  // namespace

void add_viewer_pages(Router& router) {
    for (const ViewerFile& file : viewer_files())
        router.add_encoded(std::string(file.path), [file](std::string_view accept_encoding) { return page_of(file, accept_encoding); });
}

}  // namespace meniscus::server
