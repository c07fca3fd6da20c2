#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/write.hpp>
#include <memory>

#include "publishing/publications.hpp"
#include "security/authorizer.hpp"
#include "support.hpp"
#include "web/accepts_gzip.hpp"
#include "web/http_connection.hpp"
#include "web/published_files.hpp"

namespace meniscus::fuzz {

namespace {

using boost::asio::ip::tcp;

server::Router pages() {
    server::Router router;
    router.add("/healthz", [] { return server::Page{.body = "well\n"}; });
    router.add_for_browsers("/", [](const server::PageRequest& request) {
        return server::Page{.body = server::accepts_gzip(request.accept_encoding) ? "small" : "large"};
    });
    return router;
}

constexpr const char* published = "00000000-0000-4000-8000-000000000000";

/// One publication of a segment with a frame without bricks.
class Published {
public:
    Published() : session_(all_.observe({.id = published, .kind = {.publish = true}}, {})) {
        auto frame = std::make_shared<server::EncodedFrame>();
        frame->end = std::make_shared<const std::string>("end");
        session_->encoded(std::move(frame));
        session_->ended();
    }

    std::shared_ptr<const server::PublishedFiles> files() const {
        return std::make_shared<server::PublishedFiles>(&all_, authorizer_, false);
    }

private:
    const server::Authorizer authorizer_;
    server::Publications all_{{.enabled = true, .keep = {}}, 1};
    const std::shared_ptr<server::SessionObserver> session_;
};

/// Answers every call with UNIMPLEMENTED.
class Calls {
public:
    server::GrpcWeb web() {
        return {.channel = server_->InProcessChannel({}), .origins = {}, .published = published_.files()};
    }

private:
    static std::unique_ptr<grpc::Server> start(grpc::CallbackGenericService& service) {
        grpc::ServerBuilder builder;
        builder.RegisterCallbackGenericService(&service);
        return builder.BuildAndStart();
    }

    const Published published_;
    grpc::CallbackGenericService service_;
    std::unique_ptr<grpc::Server> server_ = start(service_);
};

std::string file(const std::string& path, const std::string& fields) {
    return std::string("GET /publications/") + published + '/' + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields +
           "\r\n";
}

std::string call(const std::string& fields, const std::string& body) {
    return "POST /meniscus.v1.SurfaceService/Watch HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
           "application/grpc-web+proto\r\n" +
           fields + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

}  // namespace

void http(Bytes bytes) {
    static const server::Router router = pages();
    static Calls calls;
    static const server::GrpcWeb grpc_web = calls.web();
    static const auto context = std::make_shared<boost::asio::io_context>(1);
    static boost::asio::thread_pool worker(1);
    static tcp::acceptor acceptor(*context, {boost::asio::ip::address_v4::loopback(), 0});
    // More would fill the sockets between the two ends of this one thread.
    constexpr std::size_t most = 32768;
    tcp::socket client(*context);
    client.connect(acceptor.local_endpoint());
    bool gone = false;
    std::make_shared<server::HttpConnection>(
        acceptor.accept(), server::PeerAddress{}, nullptr, context,
        server::HttpConnection::Content{router, grpc_web, worker}, server::HttpLimits{},
        server::HttpConnection::Observer{
            .answered = [](auto&) {}, .gone = [&gone](auto&) { gone = true; }, .may_stream = [] { return true; }})
        ->start();
    boost::system::error_code ignored;
    boost::asio::write(client, boost::asio::buffer(bytes.data(), std::min(bytes.size(), most)), ignored);
    client.close();
    context->restart();
    context->run();
    require(gone, "a connection ends with its client");
}

Seeds http_seeds() {
    return {
        "GET /healthz HTTP/1.1\r\nHost: a\r\n\r\nHEAD /none?a=b HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
        "GET /none HTTP/1.0\r\n\r\n",
        "POST /healthz HTTP/1.1\r\nHost: a\r\nContent-Length: 3\r\n\r\nabc",
        "GET / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: 10.0.0.1:9464\r\nAccept-Encoding: br, gzip;q=0.5\r\nIf-None-Match: W/\"1a\"\r\n\r\n",
        std::string("OPTIONS /meniscus.v1.SurfaceService/Watch HTTP/1.1\r\nHost: [::1]:9464\r\n") +
            "Origin: http://localhost:5173\r\n\r\n",
        file("manifest.json", "Range: bytes=2-99999999999999999999\r\nIf-Range: \"a\"\r\n"),
        file("manifest.json", "Origin: http://localhost\r\nRange: bytes=-0\r\n"),
        file("../%2e%2e/" + std::string(64, 'a') + ".segment", "If-None-Match: *\r\n"),
        call("grpc-timeout: 100m\r\nX-Session-Id: a\r\n", std::string(5, '\0')),
        call("Authorization: Bearer a\r\nOrigin: http://localhost\r\n", std::string("\0\0\0\0\3abc", 8)),
        "POST /meniscus.v1.ServerService/GetServerInfo HTTP/1.1\r\nHost: a\r\nContent-Type: "
        "application/grpc-web\r\nTransfer-Encoding: chunked\r\n\r\n" +
            std::string("5\r\n\0\0\0\0\0\r\n0\r\n\r\n", 15)};
}

}  // namespace meniscus::fuzz
