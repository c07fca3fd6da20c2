// The HTTP port: accepts connections and bounds their number. One thread serves them all; a second one makes files of
// meshes.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <future>
#include <list>
#include <memory>
#include <string>
#include <thread>

#include "process/line_limit.hpp"
#include "security/tls_context.hpp"
#include "security/trusted_peers.hpp"
#include "web/grpc_web.hpp"
#include "web/http_connection.hpp"
#include "web/http_limits.hpp"
#include "web/router.hpp"

namespace meniscus::server {

class HttpServer {
public:
    /// listen: "HOST:PORT", port 0 for a free one. tls: none for HTTP alone. trusted: without limits for each peer.
    /// Listens when it returns. Throws InvalidInput if it cannot.
    HttpServer(const std::string& listen, Router router, GrpcWeb grpc_web = {}, const HttpLimits& limits = {},
               std::shared_ptr<const TlsContext> tls = nullptr, TrustedPeers trusted = TrustedPeers());
    /// Cuts the connections off.
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// The address in the form that clients use, with the port that was chosen.
    const std::string& address() const noexcept { return address_; }
    /// Takes no new connections, and returns when clients have taken the answers under way, or at the deadline. Call it
    /// once.
    void finish(std::chrono::system_clock::time_point deadline);

private:
    void serve();
    void accept();
    void accepted(boost::beast::error_code error, boost::asio::ip::tcp::socket socket);
    void welcome(boost::asio::ip::tcp::socket socket);
    /// Makes room for one more connection. False if there is none.
    bool make_room(const PeerAddress& peer);
    /// The connection of this share that has been silent longest, and carries no stream, makes room. False if all do.
    bool close_silent(const PeerAddress* share);

    void remove(HttpConnection& connection);

    const Router router_;
    const GrpcWeb grpc_web_;
    const HttpLimits limits_;
    const std::shared_ptr<const TlsContext> tls_;
    const TrustedPeers trusted_;
    std::list<HttpConnection*> connections_;  ///< the one that has been silent longest first
    bool finishing_ = false;
    std::promise<void> none_;  ///< kept once no connection is left
    boost::asio::thread_pool worker_{1};
    /// After them: its handlers own the connections. Shared with calls, whose gRPC threads may be the last to leave it.
    std::shared_ptr<boost::asio::io_context> context_ = std::make_shared<boost::asio::io_context>(1);
    boost::asio::ip::tcp::acceptor acceptor_{*context_};
    boost::asio::steady_timer retry_{*context_};
    LineLimit failures_;  ///< to accept
    std::string address_;
    std::thread thread_;
};

}  // namespace meniscus::server
