// What an HTTP request is answered with.
#pragma once

#include <string>

namespace meniscus::server {

struct Page {
    unsigned status = 200;
    std::string content_type = "text/plain; charset=utf-8";
    std::string body;
};

}  // namespace meniscus::server
