// gRPC-Web as a browser speaks it, and as one never would.
#pragma once

#include <google/protobuf/message_lite.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "observation/http_client.hpp"

namespace meniscus::server::test {

inline std::string web_message(std::string_view bytes, char flags = 0) {
    const auto n = static_cast<std::uint32_t>(bytes.size());
    std::string framed{flags};
    for (const int shift : {24, 16, 8, 0}) framed += static_cast<char>(n >> shift & 0xff);
    return framed + std::string(bytes);
}

/// One call on a connection of its own, read as far as asked.
class WebCall {
public:
    using Headers = std::vector<std::pair<std::string, std::string>>;

    static std::string request(const std::string& method, const std::string& body, const Headers& headers,
                               const std::string& version = "1.1") {
        std::string text = "POST " + method + " HTTP/" + version +
                           "\r\nHost: localhost\r\nConnection: close\r\nContent-Type: application/grpc-web+proto\r\n";
        for (const auto& [name, value] : headers) text.append(name).append(": ").append(value).append("\r\n");
        return text + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
    }

    WebCall(const std::string& address, const std::string& method, const google::protobuf::MessageLite& asked,
            const Headers& headers = {}, const std::string& version = "1.1")
        : client_(address) {
        client_.send(request(method, web_message(asked.SerializeAsString()), headers, version));
        while (header.find("\r\n\r\n") == std::string::npos)
            if (!more(header)) return;
        const std::size_t end = header.find("\r\n\r\n") + 4;
        wire_ = header.substr(end);
        header.resize(end);
    }

    /// The next message; none after the trailers, which `status`, `message` and `session_end` then hold.
    std::optional<std::string> next() {
        constexpr std::size_t header_bytes = 5;
        for (;;) {
            unchunk();
            if (body_.size() >= header_bytes) {
                std::size_t length = 0;
                for (std::size_t i = 1; i < header_bytes; ++i)
                    length = length << 8 | static_cast<unsigned char>(body_[i]);
                if (body_.size() >= header_bytes + length) {
                    const bool trailers = body_[0] != 0;
                    std::string bytes = body_.substr(header_bytes, length);
                    body_.erase(0, header_bytes + length);
                    if (!trailers) return bytes;
                    end(bytes);
                    return std::nullopt;
                }
            }
            if (!more(wire_)) return std::nullopt;
        }
    }

    std::string header;
    int status = -1;
    std::string message;
    std::string session_end;

private:
    bool more(std::string& to) {
        const std::string bytes = client_.take();
        to += bytes;
        return !bytes.empty();
    }

    void unchunk() {
        if (header.find("chunked") == std::string::npos) {
            body_ += wire_;
            wire_.clear();
            return;
        }
        for (std::size_t line = 0; (line = wire_.find("\r\n")) != std::string::npos;) {
            const std::size_t size = std::stoul(wire_.substr(0, line), nullptr, 16);
            if (wire_.size() < line + 2 + size + 2) return;
            body_ += wire_.substr(line + 2, size);
            wire_.erase(0, line + 2 + size + 2);
        }
    }

    void end(const std::string& trailers) {
        const auto value = [&](const std::string& name) {
            const std::size_t at = trailers.find(name + ": ");
            if (at == std::string::npos) return std::string();
            const std::size_t first = at + name.size() + 2;
            return trailers.substr(first, trailers.find("\r\n", first) - first);
        };
        status = std::stoi(value("grpc-status"));
        message = value("grpc-message");
        session_end = value("x-session-end");
    }

    HttpClient client_;
    std::string wire_;
    std::string body_;
};

}  // namespace meniscus::server::test
