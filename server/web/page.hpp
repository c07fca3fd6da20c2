// The answer to an HTTP request.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server {

struct Page {
    unsigned status = 200;
    std::string content_type = "text/plain; charset=utf-8";
    std::string body{};
    std::string_view lasting_body{};  ///< in place of `body`: borrowed, outlives the router or is kept by `memory`
    std::string cache_control = "no-store";
    std::vector<std::pair<std::string, std::string>> headers{};  ///< beside those that every answer has
    std::shared_ptr<const void> memory{};  ///< kept until the body has been sent: what is charged for it, or has it
};

}  // namespace meniscus::server
