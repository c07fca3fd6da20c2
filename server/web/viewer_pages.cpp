#include "web/viewer_pages.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>
#include <zlib.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "viewer_files.hpp"
#include "web/accepts_gzip.hpp"

namespace meniscus::server {

namespace {

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

/// Weak, for it stands for the bytes with and without compression.
std::string entity_tag(std::span<const unsigned char> bytes) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
    SHA256(bytes.data(), bytes.size(), digest.data());
    std::string tag = "W/\"";
    constexpr std::size_t shown = 12;
    for (std::size_t i = 0; i < shown; ++i) tag += fmt::format("{:02x}", digest[i]);
    return tag + '"';
}

class ViewerPage {
public:
    ViewerPage(const viewer::File& file, std::string page_policy)
        : file_(file), tag_(entity_tag(file.bytes)), policy_(std::move(page_policy)) {}

    Page answer(const PageRequest& request) {
        Page page{.content_type = std::string(file_.content_type),
                  .cache_control = file_.hashed ? "public, max-age=31536000, immutable" : "no-cache",
                  .headers = {{"ETag", tag_},
                              {"Vary", "Accept-Encoding"},
                              {"Content-Security-Policy", policy_},
                              {"Cross-Origin-Opener-Policy", "same-origin"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "no-referrer"}}};
        if (request.if_none_match == "*" || request.if_none_match.find(tag_) != std::string_view::npos) {
            page.status = 304;
        } else if (!file_.compressed || accepts_gzip(request.accept_encoding)) {
            if (file_.compressed) page.headers.emplace_back("Content-Encoding", "gzip");
            page.lasting_body = {reinterpret_cast<const char*>(file_.bytes.data()), file_.bytes.size()};
        } else {
            if (plain_.empty()) plain_ = inflated(file_.bytes);
            page.lasting_body = plain_;
        }
        return page;
    }

private:
    const viewer::File file_;
    const std::string tag_;
    const std::string policy_;
    std::string plain_;  ///< for the few that do not take gzip; empty until one asks
};

}  // namespace

void add_viewer_pages(Router& router, const FrameAncestors& ancestors) {
    const std::string page_policy = std::string(viewer::content_policy) + ancestors.directive();
    for (const viewer::File& file : viewer::files())
        router.add_for_browsers(std::string(file.path),
                                [page = std::make_shared<ViewerPage>(file, page_policy)](const PageRequest& request) {
                                    return page->answer(request);
                                });
}

}  // namespace meniscus::server
