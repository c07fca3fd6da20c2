#include "web/router.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

namespace meniscus::server {

void Router::add(std::string path, Handler handler) {
    add_encoded(std::move(path), [handler = std::move(handler)](std::string_view) { return handler(); });
}

void Router::add_encoded(std::string path, EncodingHandler handler) {
    handlers_.insert_or_assign(std::move(path), std::move(handler));
}

Page Router::answer(std::string_view target, std::string_view accept_encoding) const {
    const auto found = handlers_.find(target.substr(0, target.find('?')));
    if (found == handlers_.end()) {
        Page page{.status = 404, .body = "There is nothing here. There is something at"};
        for (const auto& [path, handler] : handlers_) page.body += ' ' + path;
        page.body += '\n';
        return page;
    }
    try {
        return found->second(accept_encoding);
    } catch (const std::exception& error) {
        spdlog::error("HTTP {}: internal error: {}", found->first, error.what());
        return {.status = 500, .body = "Internal error; the server's log says more.\n"};
    }
}

}  // namespace meniscus::server
