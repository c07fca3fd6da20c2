// HTTP paths to what answers them.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "web/page.hpp"

namespace meniscus::server {

class Router {
public:
    /// Called on the HTTP thread, one call at a time.
    using Handler = std::function<Page()>;
    /// accept_encoding: as the client sent it.
    using EncodingHandler = std::function<Page(std::string_view accept_encoding)>;

    /// path: as "/healthz".
    void add(std::string path, Handler handler);
    void add_encoded(std::string path, EncodingHandler handler);
    /// target: as in the request line; what follows a question mark is ignored. A path without a handler is answered with
    /// 404, a handler that throws with 500.
    Page answer(std::string_view target, std::string_view accept_encoding = {}) const;

private:
    std::map<std::string, EncodingHandler, std::less<>> handlers_;
};

}  // namespace meniscus::server
