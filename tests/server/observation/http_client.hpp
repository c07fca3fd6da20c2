// An HTTP client that can misbehave.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace meniscus::server::test {

/// Status, header and body, as they came.
struct HttpAnswer {
    int status = 0;
    std::string header;
    std::string body;
};

class HttpClient {
public:
    /// address: "127.0.0.1:PORT".
    explicit HttpClient(const std::string& address) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
        ::inet_pton(AF_INET, address.substr(0, address.rfind(':')).c_str(), &to.sin_addr);
        const timeval guard{.tv_sec = 30, .tv_usec = 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &guard, sizeof guard);
        if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
            ::close(socket_);
            throw std::runtime_error("no HTTP server at " + address);
        }
    }
    ~HttpClient() { ::close(socket_); }
    HttpClient(const HttpClient&) = delete;
    HttpClient& operator=(const HttpClient&) = delete;

    /// False once the server has cut the connection.
    bool send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }

    /// Status 0 if the server closes the connection instead. without_body: the answer to a HEAD.
    HttpAnswer receive(bool without_body = false) {
        std::size_t end = 0;
        while ((end = received_.find("\r\n\r\n")) == std::string::npos)
            if (!receive_more()) return {};
        HttpAnswer answer{
            .status = std::stoi(received_.substr(9, 3)), .header = received_.substr(0, end + 2), .body = {}};
        received_.erase(0, end + 4);
        const std::size_t length = answer.header.find("Content-Length: ");
        const std::size_t size =
            without_body || length == std::string::npos ? 0 : std::stoul(answer.header.substr(length + 16));
        while (received_.size() < size)
            if (!receive_more()) return {};
        answer.body = received_.substr(0, size);
        received_.erase(0, size);
        return answer;
    }

    HttpAnswer get(const std::string& target) {
        send("GET " + target + " HTTP/1.1\r\nHost: test\r\n\r\n");
        return receive();
    }

    /// The bytes that come next, as they are on the wire; none at the connection's end.
    std::string take() {
        if (received_.empty()) receive_more();
        return std::exchange(received_, {});
    }

    /// Whether the server ends the connection, once all that it sent has been read.
    bool ended() {
        while (receive_more()) {
        }
        return !timed_out_;
    }

private:
    bool receive_more() {
        char bytes[16384];
        const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
        timed_out_ = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
        if (count <= 0) return false;
        received_.append(bytes, static_cast<std::size_t>(count));
        return true;
    }

    int socket_;
    std::string received_;
    bool timed_out_ = false;
};

/// One request on a connection of its own.
inline HttpAnswer http_get(const std::string& address, const std::string& target) {
    return HttpClient(address).get(target);
}

}  // namespace meniscus::server::test
