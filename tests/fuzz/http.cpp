#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <memory>

#include "support.hpp"
#include "web/http_connection.hpp"

namespace meniscus::fuzz {

namespace {

using boost::asio::ip::tcp;

server::Router pages() {
    server::Router router;
    router.add("/healthz", [] { return server::Page{.body = "well\n"}; });
    return router;
}

}  // namespace

void http(Bytes bytes) {
    static const server::Router router = pages();
    static const server::GrpcWeb grpc_web;
    static boost::asio::io_context context(1);
    static tcp::acceptor acceptor(context, {boost::asio::ip::address_v4::loopback(), 0});
    // More would fill the sockets between the two ends of this one thread.
    constexpr std::size_t most = 32768;
    tcp::socket client(context);
    client.connect(acceptor.local_endpoint());
    bool gone = false;
    std::make_shared<server::HttpConnection>(
        acceptor.accept(), context.get_executor(), router, grpc_web, server::HttpLimits{},
        server::HttpConnection::Observer{.answered = [](auto&) {}, .gone = [&gone](auto&) { gone = true; }})
        ->start();
    boost::system::error_code ignored;
    boost::asio::write(client, boost::asio::buffer(bytes.data(), std::min(bytes.size(), most)), ignored);
    client.close();
    context.restart();
    context.run();
    require(gone, "a connection ends with its client");
}

Seeds http_seeds() {
    return {"GET /healthz HTTP/1.1\r\nHost: a\r\n\r\nHEAD /none?a=b HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
            "GET /none HTTP/1.0\r\n\r\n", "POST /healthz HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc",
            "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n"};
}

}  // namespace meniscus::fuzz
