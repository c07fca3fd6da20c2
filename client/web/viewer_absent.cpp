// The page that stands for the viewer in a build without it.
#include <array>

#include "viewer_files.hpp"

namespace meniscus::viewer {

namespace {

constexpr unsigned char page[] =
    "<!doctype html><html lang=\"en\"><head><meta "
    "charset=\"utf-8\"><title>Meniscus</title></head><body><h1>Meniscus</h1>"
    "<p>This meniscusd was built without its viewer: npm was not there. Install Node.js and npm, configure again with "
    "<code>-DMENISCUS_WEB=ON</code>, and build.</p>"
    "<p>Metrics are at <a href=\"/metrics\">/metrics</a>.</p></body></html>\n";

constexpr std::array<File, 1> all{{{"/", "text/html; charset=utf-8", false, false, {page, sizeof page - 1}}}};

}  // namespace

std::span<const File> files() {
    return all;
}

std::span<const unsigned char> single_page() {
    return {};
}

}  // namespace meniscus::viewer
