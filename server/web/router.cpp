#include "web/router.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

namespace meniscus::server {

void Router::add(std::string path, Handler handler) {
    entries_.insert_or_assign(
        std::move(path), Entry{.handler = [handler = std::move(handler)](const PageRequest&) { return handler(); }});
}

void Router::add_for_browsers(std::string path, BrowserHandler handler) {
    entries_.insert_or_assign(std::move(path), Entry{.handler = std::move(handler), .for_browsers = true});
}

bool Router::is_for_browsers(std::string_view target) const {
    const auto found = find(target);
    return found != entries_.end() && found->second.for_browsers;
}

Page Router::answer(std::string_view target, const PageRequest& request) const {
    const auto found = find(target);
    if (found == entries_.end()) {
        Page page{.status = 404, .body = "There is nothing here. There is something at"};
        for (const auto& [path, entry] : entries_) page.body += ' ' + path;
        page.body += '\n';
        return page;
    }
    try {
        return found->second.handler(request);
    } catch (const std::exception& error) {
        spdlog::error("HTTP {}: internal error: {}", found->first, error.what());
        return {.status = 500, .body = "Internal error; the server's log says more.\n"};
    }
}

}  // namespace meniscus::server
