#include "web/frame_ancestors.hpp"

#include <fmt/format.h>

#include "meniscus/error.hpp"
#include "web/origins.hpp"

namespace meniscus::server {

FrameAncestors::FrameAncestors(const std::vector<std::string>& origins) {
    if (origins.empty()) return;
    directive_ = "frame-ancestors";
    for (const std::string& origin : origins) {
        constexpr const char* flag = "--web-frame-ancestors";
        require_origin(flag, origin);
        // The grammar of policies has no such hosts: browsers would pass over it in silence.
        if (origin.find('[') != std::string::npos)
            throw InvalidInput(fmt::format(
                "{} has \"{}\"; browsers compare with no address of IPv6 there: name the host", flag, origin));
        directive_ += ' ' + origin;
    }
}

}  // namespace meniscus::server
