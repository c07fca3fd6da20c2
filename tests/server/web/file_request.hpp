// Requests for the HTTP port's files, and what their answers say.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "observation/http_client.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {

using Headers = std::vector<std::pair<std::string, std::string>>;

inline ServerOptions web_options() {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    return options;
}

inline HttpAnswer ask(const std::string& address, const std::string& target, const Headers& headers = {},
                      const std::string& method = "GET") {
    std::string request = method + " " + target + " HTTP/1.1\r\n";
    if (std::ranges::none_of(headers, [](const auto& header) { return header.first == "Host"; }))
        request += "Host: localhost\r\n";
    for (const auto& [name, value] : headers) request.append(name).append(": ").append(value).append("\r\n");
    HttpClient client(address);
    client.send(request + "\r\n");
    return client.receive(method == "HEAD");
}

/// The header's value; empty without it.
inline std::string value_of(const HttpAnswer& answer, const std::string& name) {
    const std::size_t at = answer.header.find("\r\n" + name + ": ");
    if (at == std::string::npos) return {};
    const std::size_t first = at + name.size() + 4;
    return answer.header.substr(first, answer.header.find("\r\n", first) - first);
}

/// A request that is refused, with words in its answer.
struct RefusedRequest {
    std::string target;
    std::string method;
    Headers headers;
    int status;
    std::string words;
};

inline void expect_refused(const std::string& address, const std::vector<RefusedRequest>& requests) {
    for (const RefusedRequest& each : requests) {
        const HttpAnswer answer = ask(address, each.target, each.headers, each.method);
        EXPECT_EQ(answer.status, each.status) << each.method << ' ' << each.target << ": " << answer.body;
        EXPECT_NE(answer.body.find(each.words), std::string::npos) << answer.body;
        EXPECT_EQ(value_of(answer, "Cache-Control"), "no-store") << each.target;
    }
}

}  // namespace meniscus::server::test
