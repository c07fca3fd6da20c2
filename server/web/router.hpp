// Finds the handler of an HTTP path.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "web/page.hpp"

namespace meniscus::server {

/// Headers that a page may depend on, as they came; empty: not sent.
struct PageRequest {
    std::string_view accept_encoding;
    std::string_view if_none_match;
};

class Router {
public:
    /// Called on the HTTP thread, one call at a time.
    using Handler = std::function<Page()>;
    using BrowserHandler = std::function<Page(const PageRequest& request)>;

    /// path: as "/healthz". Answers requests to any host name: for machines, which may know this one by another.
    void add(std::string path, Handler handler);
    /// Answers requests to a host name that the server is known by, and no others.
    void add_for_browsers(std::string path, BrowserHandler handler);
    bool is_for_browsers(std::string_view target) const;
    /// target: as in the request line; what follows a question mark is ignored. A path without a handler is answered
    /// with 404, a handler that throws with 500.
    Page answer(std::string_view target, const PageRequest& request = {}) const;

private:
    struct Entry {
        BrowserHandler handler;
        bool for_browsers = false;
    };
    using Entries = std::map<std::string, Entry, std::less<>>;

    Entries::const_iterator find(std::string_view target) const {
        return entries_.find(target.substr(0, target.find('?')));
    }

    Entries entries_;
};

}  // namespace meniscus::server
