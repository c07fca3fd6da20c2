#include "web/http_server.hpp"

#include <fmt/format.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <utility>

#include "connections/listen_address.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

using boost::asio::ip::tcp;

/// The pause after an accept that failed, most likely for want of descriptors.
constexpr auto accept_pause = std::chrono::milliseconds(100);
constexpr int unsent_bytes = 256 << 10;
/// Seconds until a silent client is asked whether it is there, between two such questions, and how many may fail: as on
/// the gRPC port.
constexpr int silence = 30;
constexpr int question_gap = 5;
constexpr int questions = 4;

void set_options(int socket) {
    const auto set = [socket](int level, int name, int value) {
        ::setsockopt(socket, level, name, &value, sizeof value);
    };
    // Bytes that wait in the kernel for a slow viewer are old by the time they are shown: with few, newer frames take
    // their place.
    set(IPPROTO_TCP, TCP_NOTSENT_LOWAT, unsent_bytes);
    // A viewer that vanished without a goodbye is noticed, though its session may be still.
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, silence);
    set(IPPROTO_TCP, TCP_KEEPINTVL, question_gap);
    set(IPPROTO_TCP, TCP_KEEPCNT, questions);
}

/// The endpoint of "HOST:PORT" or "[IPv6]:PORT".
tcp::endpoint resolve(boost::asio::io_context& context, const std::string& listen) {
    const HostPort address = parse_host_port("--http", listen);
    boost::system::error_code error;
    const auto found =
        tcp::resolver(context).resolve(address.host, std::to_string(address.port), tcp::resolver::passive, error);
    if (error) throw InvalidInput(fmt::format("cannot serve HTTP on {}: {}", listen, error.message()));
    return *found.begin();
}

}  // namespace

HttpServer::HttpServer(const std::string& listen, Router router, GrpcWeb grpc_web, const HttpLimits& limits,
                       std::shared_ptr<const TlsContext> tls, TrustedPeers trusted)
    : router_(std::move(router)),
      grpc_web_(std::move(grpc_web)),
      limits_(limits),
      tls_(std::move(tls)),
      trusted_(std::move(trusted)) {
    const tcp::endpoint endpoint = resolve(*context_, listen);
    try {
        acceptor_.open(endpoint.protocol());
        acceptor_.set_option(tcp::acceptor::reuse_address(true));
        acceptor_.bind(endpoint);
        acceptor_.listen();
    } catch (const boost::system::system_error& error) {
        throw AddressUnavailable(fmt::format("cannot serve HTTP on {}: {}", listen, error.code().message()));
    }
    address_ = fmt::format("{}:{}", listen.substr(0, listen.rfind(':')), acceptor_.local_endpoint().port());
    accept();
    thread_ = std::thread([this] { serve(); });
}

HttpServer::~HttpServer() {
    boost::asio::post(*context_, [this] {
        acceptor_.close();
        retry_.cancel();
        for (HttpConnection* connection : connections_) connection->close();
    });
    thread_.join();
}

void HttpServer::finish(std::chrono::system_clock::time_point deadline) {
    const std::future<void> none = none_.get_future();
    boost::asio::post(*context_, [this] {
        acceptor_.close();
        retry_.cancel();
        finishing_ = true;
        for (HttpConnection* connection : connections_) connection->leave();
        if (connections_.empty()) none_.set_value();
    });
    none.wait_until(deadline);
}

void HttpServer::serve() {
    for (;;) {
        try {
            context_->run();
            return;
        } catch (const std::exception& error) {  // of one connection, which is gone with it
            spdlog::error("HTTP: internal error: {}", error.what());
        }
    }
}

void HttpServer::accept() {
    acceptor_.async_accept(
        [this](boost::beast::error_code error, tcp::socket socket) { accepted(error, std::move(socket)); });
}

void HttpServer::accepted(boost::beast::error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {
        if (const auto left = failures_.pass())
            spdlog::warn("an HTTP connection was not accepted: {}{}", error.message(), left_out(*left));
        retry_.expires_after(accept_pause);
        retry_.async_wait([this](boost::beast::error_code canceled) {
            if (!canceled && acceptor_.is_open()) accept();
        });
        return;
    }
    welcome(std::move(socket));
    accept();
}

void HttpServer::welcome(tcp::socket socket) {
    set_options(socket.native_handle());
    boost::system::error_code gone;
    const auto remote = socket.remote_endpoint(gone);
    if (gone) return;
    const PeerAddress peer(*remote.data());
    if (!make_room(peer)) return;
    const auto connection = std::make_shared<HttpConnection>(
        std::move(socket), peer.share(), tls_ ? tls_->current() : nullptr, context_,
        HttpConnection::Content{router_, grpc_web_, worker_}, limits_,
        HttpConnection::Observer{.answered =
                                     [this](HttpConnection& active) {
                                         connections_.remove(&active);
                                         connections_.push_back(&active);
                                     },
                                 .gone = [this](HttpConnection& ended) { remove(ended); },
                                 .may_stream =
                                     [this] {
                                         return std::cmp_less(
                                             std::ranges::count_if(connections_, &HttpConnection::streams),
                                             limits_.streams);
                                     }});
    connections_.push_back(connection.get());
    connection->start();
}

bool HttpServer::make_room(const PeerAddress& peer) {
    const PeerAddress share = peer.share();
    const auto is_of_peer = [&share](const HttpConnection* each) { return each->share() == share; };
    if (limits_.connections_per_peer != 0 && !trusted_.is_exempt(peer) &&
        std::cmp_greater_equal(std::ranges::count_if(connections_, is_of_peer), limits_.connections_per_peer))
        return close_silent(&share);
    return connections_.size() < limits_.connections || close_silent(nullptr);
}

bool HttpServer::close_silent(const PeerAddress* share) {
    const auto silent = std::ranges::find_if(connections_, [share](const HttpConnection* each) {
        return !each->streams() && (share == nullptr || each->share() == *share);
    });
    if (silent == connections_.end()) return false;
    HttpConnection& closed = **silent;
    connections_.erase(silent);
    closed.close();
    return true;
}

void HttpServer::remove(HttpConnection& connection) {
    if (connections_.remove(&connection) != 0 && finishing_ && connections_.empty()) none_.set_value();
}

}  // namespace meniscus::server
