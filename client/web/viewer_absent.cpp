// In place of the viewer, where it was not built.
#include <array>

#include "web/viewer_files.hpp"

namespace meniscus::server {

namespace {

constexpr unsigned char page[] =
    "<!doctype html><html lang=\"en\"><head><meta "
    "charset=\"utf-8\"><title>Meniscus</title></head><body><h1>Meniscus</h1>"
    "<p>This meniscusd was built without its viewer: npm was not there. Install Node.js and npm, configure again with "
    "<code>-DMENISCUS_WEB=ON</code>, and build.</p>"
    "<p>Metrics are at <a href=\"/metrics\">/metrics</a>.</p></body></html>\n";

constexpr std::array<ViewerFile, 1> files{{{"/", "text/html; charset=utf-8", false, false, {page, sizeof page - 1}}}};

}  // namespace

std::span<const ViewerFile> viewer_files() {
    return files;
}

}  // namespace meniscus::server
