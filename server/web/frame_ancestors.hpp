// Which web pages may show the viewer in a frame of theirs.
#pragma once

#include <string>
#include <vector>

namespace meniscus::server {

class FrameAncestors {
public:
    /// origins: as "https://example.org" or "https://example.org:8443", each exactly: no patterns. Throws InvalidInput
    /// for what is no origin, or none that browsers compare with.
    explicit FrameAncestors(const std::vector<std::string>& origins);
    FrameAncestors() = default;

    /// The directive of a Content-Security-Policy: browsers show the page in no other frames. (They take a host's https
    /// for its http.)
    const std::string& directive() const noexcept { return directive_; }

private:
    std::string directive_ = "frame-ancestors 'none'";
};

}  // namespace meniscus::server
