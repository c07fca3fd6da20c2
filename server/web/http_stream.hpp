// The bytes of one HTTP connection: over TCP, or over TLS.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <memory>
#include <optional>
#include <utility>

namespace meniscus::server {

/// An AsyncReadStream and AsyncWriteStream, as Beast wants them, for handlers that are functions.
class HttpStream {
public:
    using executor_type = boost::beast::tcp_stream::executor_type;

    /// tls: none for TCP alone.
    HttpStream(boost::asio::ip::tcp::socket socket, std::shared_ptr<boost::asio::ssl::context> tls)
        : tcp_(std::move(socket)), context_(std::move(tls)) {
        if (context_) tls_.emplace(tcp_, *context_);
    }
    HttpStream(const HttpStream&) = delete;  // tls_ knows where tcp_ is
    HttpStream& operator=(const HttpStream&) = delete;

    executor_type get_executor() noexcept { return tcp_.get_executor(); }
    /// The TCP stream, for time limits and to cut the connection.
    boost::beast::tcp_stream& tcp() noexcept { return tcp_; }
    /// Whether there is TLS: then async_handshake() comes before anything is read.
    bool has_tls() const noexcept { return tls_.has_value(); }
    bool has_client_certificate() { return tls_ && SSL_get0_peer_certificate(tls_->native_handle()) != nullptr; }

    template <class Handler>
    void async_handshake(Handler&& handler) {
        tls_->async_handshake(boost::asio::ssl::stream_base::server, std::forward<Handler>(handler));
    }
    /// The goodbye of TLS.
    template <class Handler>
    void async_shutdown(Handler&& handler) {
        tls_->async_shutdown(std::forward<Handler>(handler));
    }
    template <class Buffers, class Handler>
    void async_read_some(const Buffers& buffers, Handler&& handler) {
        if (tls_)
            tls_->async_read_some(buffers, std::forward<Handler>(handler));
        else
            tcp_.async_read_some(buffers, std::forward<Handler>(handler));
    }
    template <class Buffers, class Handler>
    void async_write_some(const Buffers& buffers, Handler&& handler) {
        if (tls_)
            tls_->async_write_some(buffers, std::forward<Handler>(handler));
        else
            tcp_.async_write_some(buffers, std::forward<Handler>(handler));
    }

private:
    boost::beast::tcp_stream tcp_;
    std::shared_ptr<boost::asio::ssl::context> context_;
    std::optional<boost::asio::ssl::stream<boost::beast::tcp_stream&>> tls_;
};

}  // namespace meniscus::server
