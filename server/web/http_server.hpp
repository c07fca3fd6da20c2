// The HTTP port: accepts connections and bounds their number. One thread serves them all.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <list>
#include <memory>
#include <string>
#include <thread>

#include "web/grpc_web.hpp"
#include "web/http_connection.hpp"
#include "web/http_limits.hpp"
#include "web/router.hpp"

namespace meniscus::server {

class HttpServer {
public:
    /// listen: "HOST:PORT", port 0 for a free one. Listens when it returns. Throws InvalidInput if it cannot.
    HttpServer(const std::string& listen, Router router, GrpcWeb grpc_web = {}, const HttpLimits& limits = {});
    /// Cuts the connections off.
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// As clients should give it, the port being the one chosen.
    const std::string& address() const noexcept { return address_; }

private:
    void serve();
    void accept();
    void accepted(boost::beast::error_code error, boost::asio::ip::tcp::socket socket);
    void welcome(boost::asio::ip::tcp::socket socket);

    const Router router_;
    const GrpcWeb grpc_web_;
    const HttpLimits limits_;
    std::list<HttpConnection*> connections_;  ///< the one that has been silent longest first
    boost::asio::io_context context_{1};      ///< after them: its handlers own the connections
    boost::asio::ip::tcp::acceptor acceptor_{context_};
    boost::asio::steady_timer retry_{context_};
    std::string address_;
    std::thread thread_;
};

}  // namespace meniscus::server
