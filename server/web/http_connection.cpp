#include "web/http_connection.hpp"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/sslerr.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "rpc/messages/session_id.hpp"
#include "security/web_peer.hpp"
#include "web/beast_text.hpp"
#include "web/call_metadata.hpp"
#include "web/grpc_web_messages.hpp"

namespace meniscus::server {

namespace http = boost::beast::http;

namespace {

/// The most bytes and time of a client that still sends while it is answered for the last time.
constexpr std::size_t linger_bytes = std::size_t{1} << 20;
constexpr auto linger_time = std::chrono::seconds(2);

constexpr std::string_view not_tls =
    "HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: 49\r\nConnection: "
    "close\r\n\r\n"
    "This port speaks TLS: the address is https://...\n";

/// The answer to a browser that asks whether a page may make a call.
Page preflight_page(std::string_view origin, std::string_view methods) {
    Page page{.status = 204, .headers = cross_origin_headers(origin)};
    page.headers.emplace_back("Access-Control-Allow-Methods", methods);
    page.headers.emplace_back(
        "Access-Control-Allow-Headers",
        "authorization, content-type, grpc-timeout, if-none-match, if-range, range, x-grpc-web, x-session-id, "
        "x-user-agent");
    page.headers.emplace_back("Access-Control-Max-Age", "600");
    return page;
}

}  // namespace

HttpConnection::HttpConnection(boost::asio::ip::tcp::socket socket, const PeerAddress& share,
                               std::shared_ptr<boost::asio::ssl::context> tls,
                               std::shared_ptr<boost::asio::io_context> context, Content content,
                               const HttpLimits& limits, Observer observer)
    : stream_(std::move(socket), std::move(tls)),
      share_(share),
      context_(std::move(context)),
      content_(content),
      limits_(limits),
      observer_(std::move(observer)),
      // Room for one header and for what a client sends ahead; more of that stays in the socket.
      buffer_(std::size_t{2} * limits.header_bytes) {}

HttpConnection::~HttpConnection() {
    observer_.gone(*this);
}

void HttpConnection::start() {
    if (stream_.has_tls())
        shake_hands();
    else
        read();
}

void HttpConnection::leave() {
    leaving_ = true;
    if (!busy_) stream_.tcp().close();
}

void HttpConnection::close() {
    if (exchange_) exchange_->cancel();
    if (mesh_) mesh_->cancel();
    stream_.tcp().close();
}

void HttpConnection::shake_hands() {
    stream_.tcp().expires_after(limits_.patience);
    stream_.async_handshake([self = shared_from_this()](boost::beast::error_code error) {
        if (!error) return self->read();
        if (error.category() == boost::asio::error::get_ssl_category() &&
            ERR_GET_REASON(static_cast<unsigned long>(error.value())) == SSL_R_HTTP_REQUEST)
            self->name_tls();
    });
}

void HttpConnection::name_tls() {
    stream_.tcp().expires_after(limits_.patience);
    boost::asio::async_write(stream_.tcp(), boost::asio::buffer(not_tls),
                             [self = shared_from_this()](boost::beast::error_code, std::size_t) {});
}

void HttpConnection::read() {
    busy_ = false;
    is_call_ = false;
    is_mesh_ = false;
    if (leaving_) return end_connection();
    call_parser_.reset();
    parser_.emplace();
    parser_->header_limit(limits_.header_bytes);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read: answer() refuses them
    // For the whole header: a client that sends it byte by byte gains nothing.
    stream_.tcp().expires_after(limits_.patience);
    http::async_read_header(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](boost::beast::error_code error, std::size_t) { self->receive(error); });
}

void HttpConnection::receive(boost::beast::error_code error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
        return refuse(431, fmt::format("The header is larger than {} bytes.\n", limits_.header_bytes));
    if (error.category() == http::make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message)
        return refuse(400, fmt::format("This is no HTTP request: {}.\n", error.message()));
    if (error) return;  // gone, or too slow
    answer();
}

void HttpConnection::answer() {
    const auto& request = parser_->get();
    const std::string_view path = view(request.target());
    const std::string_view host = view(request[http::field::host]);
    const AllowedOrigins& origins = content_.grpc_web.origins;
    busy_ = true;
    constexpr unsigned http_1_1 = 11;
    if (request.version() >= http_1_1 && request.count(http::field::host) == 0)
        return refuse(400, "The request names no host: HTTP/1.1 asks for the header Host.\n");
    if (request.count(http::field::host) > 1) return refuse(400, "The request names more than one host.\n");
    is_call_ = content_.grpc_web.channel && is_method(path);
    is_mesh_ = content_.grpc_web.channel && is_mesh_target(path);
    const bool is_published = content_.grpc_web.published && is_published_target(path);
    if ((is_call_ || is_mesh_ || is_published || content_.router.is_for_browsers(path)) && !origins.knows_host(host))
        return refuse(
            421,
            fmt::format("This server is not known as {0}; use its address, or start it with --web-origin http://{0}\n",
                        escaped(host)));
    if (is_call_) {
        if (!passes_origin("POST")) return;
        if (request.method() == http::verb::post) return receive_call();
        return refuse(405, fmt::format("{} is not allowed here; POST is.\n", std::string(request.method_string())));
    }
    if ((is_mesh_ || is_published) && !passes_origin("GET, HEAD")) return;
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return refuse(405,
                      fmt::format("{} is not allowed here; GET and HEAD are.\n", std::string(request.method_string())));
    if (!parser_->is_done()) return refuse(413, "A body is not taken here.\n");
    if (is_mesh_) return answer_mesh();
    if (is_published) return answer_published();
    write(content_.router.answer(path, {.accept_encoding = view(request[http::field::accept_encoding]),
                                        .if_none_match = view(request[http::field::if_none_match])}),
          request.keep_alive());
}

bool HttpConnection::passes_origin(std::string_view methods) {
    const auto& request = parser_->get();
    const std::string_view origin = view(request[http::field::origin]);
    if (!content_.grpc_web.origins.admits(origin, view(request[http::field::host])))
        refuse(403, fmt::format("Pages of {} may not call this server; --web-origin allows them.\n", escaped(origin)));
    else if (request.method() == http::verb::options)
        write(preflight_page(origin, methods), request.keep_alive());
    else
        return true;
    return false;
}

grpc::Status HttpConnection::call_refusal(std::string_view path) {
    if (!content_.grpc_web.serves(path))
        return {grpc::StatusCode::UNIMPLEMENTED,
                fmt::format("{} is not served to browsers, only what reads", escaped(path))};
    if (content_.grpc_web.needs_certificate && !stream_.has_client_certificate())
        return {grpc::StatusCode::UNAUTHENTICATED, "calls need a client's certificate"};
    if (is_stream(path) && !observer_.may_stream())
        return {grpc::StatusCode::RESOURCE_EXHAUSTED,
                fmt::format("the HTTP port carries {} streams, its limit; watch by gRPC", limits_.streams)};
    if (const auto bytes = parser_->content_length().value_or(0); bytes > limits_.body_bytes)
        return {grpc::StatusCode::RESOURCE_EXHAUSTED,
                fmt::format("the request has {} bytes; at most {} are taken", bytes, limits_.body_bytes)};
    return grpc::Status::OK;
}

void HttpConnection::receive_call() {
    const auto& request = parser_->get();
    if (!is_grpc_web(request))
        return refuse(415, fmt::format("The content type is {}; application/grpc-web+proto is taken.\n",
                                       quoted(view(request[http::field::content_type]), '"')));
    if (const grpc::Status refusal = call_refusal(view(request.target())); !refusal.ok()) return refuse_call(refusal);
    call_parser_.emplace(std::move(*parser_));
    call_parser_->body_limit(limits_.body_bytes);
    chunks_ = 0;
    on_chunk_ = [this](std::uint64_t, boost::beast::string_view, boost::beast::error_code& error) {
        if (++chunks_ > limits_.body_chunks) error = http::make_error_code(http::error::body_limit);
    };
    call_parser_->on_chunk_header(on_chunk_);
    http::async_read(
        stream_, buffer_, *call_parser_,
        [self = shared_from_this()](boost::beast::error_code error, std::size_t) { self->answer_call(error); });
}

void HttpConnection::answer_call(boost::beast::error_code error) {
    if (error == http::error::body_limit)
        return refuse_call(
            {grpc::StatusCode::RESOURCE_EXHAUSTED,
             fmt::format("the request has more than {} bytes or {} chunks", limits_.body_bytes, limits_.body_chunks)});
    if (error.category() == http::make_error_code(http::error::bad_chunk).category() &&
        error != http::error::partial_message)
        return refuse(400, fmt::format("This is no HTTP body: {}.\n", error.message()));
    if (error) return;  // gone, or too slow
    BridgedCall::Request call;
    if (const grpc::Status refusal = bridged_request(call_parser_->get(), call); !refusal.ok())
        return refuse_call(refusal);
    call.metadata.emplace_back(web_peer_key, peer());
    streams_ = is_stream(call.method);
    exchange_ = std::make_shared<GrpcWebExchange>(
        stream_, context_, limits_.patience,
        [self = shared_from_this()](GrpcWebExchange::Ending ending) { self->call_ended(ending); });
    exchange_->start(content_.grpc_web.channel, call_parser_->get(), std::move(call));
}

void HttpConnection::answer_mesh() {
    const auto& request = parser_->get();
    if (const grpc::Status refusal = call_refusal(snapshot_method); !refusal.ok()) {
        count_refusal(refusal.error_code());
        return write_mesh(page_of(refusal));
    }
    MeshRequest asked;
    LatestMesh::Metadata metadata;
    try {
        asked = mesh_request(view(request.target()));
        metadata = call_metadata(request, {"authorization", forwarded_for_key});
    } catch (const InvalidInput& refusal) {
        count_refusal(grpc::StatusCode::INVALID_ARGUMENT);
        return write_mesh({.status = 400, .body = std::string(refusal.what()) + '\n'});
    }
    if (!is_session_id(asked.session)) {
        count_refusal(grpc::StatusCode::INVALID_ARGUMENT);
        return write_mesh(
            {.status = 404, .body = "There is no such session: an id has 8-4-4-4-12 lower-case hexadecimal digits.\n"});
    }
    metadata.emplace_back(web_peer_key, peer());
    streams_ = true;
    mesh_ = std::make_shared<LatestMesh>(
        context_, LatestMesh::Means{content_.grpc_web.channel, content_.grpc_web.memory, content_.worker},
        std::move(asked), std::move(metadata), std::string(request[http::field::if_none_match]),
        [self = shared_from_this()](Page page) {
            self->mesh_.reset();
            self->write_mesh(std::move(page));
        });
    mesh_->start();
}

void HttpConnection::answer_published() {
    const auto& request = parser_->get();
    const std::string_view origin = view(request[http::field::origin]);
    std::vector<std::string_view> authorization;
    const auto [first, last] = request.equal_range(http::field::authorization);
    for (auto field = first; field != last; ++field) authorization.push_back(view(field->value()));
    const bool may_come = !content_.grpc_web.needs_certificate || stream_.has_client_certificate();
    Page page = may_come
                    ? content_.grpc_web.published->answer({.target = view(request.target()),
                                                           .whole = request.method() == http::verb::head,
                                                           .if_none_match = view(request[http::field::if_none_match]),
                                                           .range = view(request[http::field::range]),
                                                           .if_range = view(request[http::field::if_range]),
                                                           .authorization = authorization,
                                                           .peer = PeerAddress::of_grpc(peer())})
                    : page_of({grpc::StatusCode::UNAUTHENTICATED, "calls need a client's certificate"});
    // Before its own: it knows better what it varies by.
    auto headers = cross_origin_headers(origin);
    headers.insert(headers.end(), page.headers.begin(), page.headers.end());
    page.headers = std::move(headers);
    // One that takes a file is not silent; beyond the number of streams it makes room as others do.
    streams_ = page.memory != nullptr && observer_.may_stream();
    write(std::move(page), request.keep_alive());
}

void HttpConnection::write_mesh(Page page) {
    const auto& request = parser_->get();
    for (auto& header : cross_origin_headers(view(request[http::field::origin])))
        page.headers.push_back(std::move(header));
    write(std::move(page), request.keep_alive());
}

std::string HttpConnection::peer() {
    boost::beast::error_code error;
    const auto end = stream_.tcp().socket().remote_endpoint(error);
    if (error) return "unknown";
    const auto address = end.address();
    return address.is_v6() ? fmt::format("ipv6:%5B{}%5D:{}", address.to_string(), end.port())
                           : fmt::format("ipv4:{}:{}", address.to_string(), end.port());
}

void HttpConnection::call_ended(GrpcWebExchange::Ending ending) {
    exchange_.reset();
    streams_ = false;
    if (!ending.answered) return;
    if (!ending.keep_alive) return end_connection();
    observer_.answered(*this);
    read();
}

void HttpConnection::refuse(unsigned status, std::string sentence) {
    if (is_call_ || is_mesh_)
        count_refusal(status == 403 ? grpc::StatusCode::PERMISSION_DENIED : grpc::StatusCode::INVALID_ARGUMENT);
    write({.status = status, .body = std::move(sentence)}, false);
}

void HttpConnection::refuse_call(const grpc::Status& status) {
    count_refusal(status.error_code());
    const RequestHeader& request = request_header();
    write({.content_type = "application/grpc-web+proto",
           .body = grpc_web_trailers(status),
           .headers = cross_origin_headers(view(request[http::field::origin]))},
          false);
}

const HttpConnection::RequestHeader& HttpConnection::request_header() const {
    if (call_parser_) return call_parser_->get();
    return parser_->get();
}

void HttpConnection::count_refusal(grpc::StatusCode code) const {
    if (content_.grpc_web.refused)
        content_.grpc_web.refused(is_mesh_ ? snapshot_method : view(request_header().target()), code);
}

void HttpConnection::write(Page page, bool keep_alive) {
    page_ = std::move(page);
    response_.emplace(http::int_to_status(page_.status), 11);
    response_->set(http::field::content_type, page_.content_type);
    response_->set(http::field::cache_control, page_.cache_control);
    response_->set("X-Content-Type-Options", "nosniff");
    for (const auto& [name, value] : page_.headers) response_->set(name, value);
    if (page_.status == 405)
        response_->set(http::field::allow,
                       content_.grpc_web.serves(view(parser_->get().target())) ? "POST, OPTIONS" : "GET, HEAD");
    response_->keep_alive(keep_alive && !leaving_);
    const std::string_view body = page_.lasting_body.empty() ? std::string_view(page_.body) : page_.lasting_body;
    response_->body() = {body.data(), body.size()};
    response_->prepare_payload();
    // They would be those of the page that the client has.
    if (page_.status == 304) {
        response_->content_length(boost::none);
        response_->erase(http::field::content_type);
    }
    serializer_.emplace(*response_);
    written_by_ = std::chrono::steady_clock::now() + limits_.patience +
                  std::chrono::seconds(body.size() / limits_.bytes_per_second);
    if (call_parser_ || parser_->get().method() != http::verb::head) return write_rest();
    stream_.tcp().expires_at(written_by_);
    http::async_write_header(
        stream_, *serializer_,
        [self = shared_from_this()](boost::beast::error_code error, std::size_t) { self->written(error); });
}

void HttpConnection::write_rest() {
    // A client that takes nothing any more must not hold a large answer's memory for as long as a slow one may.
    stream_.tcp().expires_at(std::min(written_by_, std::chrono::steady_clock::now() + limits_.patience));
    http::async_write_some(stream_, *serializer_,
                           [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
                               if (error || self->serializer_->is_done()) return self->written(error);
                               self->write_rest();
                           });
}

void HttpConnection::written(boost::beast::error_code error) {
    streams_ = false;
    page_ = {};
    if (error) return;
    if (!response_->keep_alive()) return end_connection();
    observer_.answered(*this);
    read();
}

void HttpConnection::end_connection() {
    busy_ = false;
    stream_.tcp().expires_after(linger_time);
    if (stream_.has_tls()) return stream_.async_shutdown([self = shared_from_this()](boost::beast::error_code) {});
    boost::beast::error_code ignored;
    stream_.tcp().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    if (!leaving_) linger();
}

void HttpConnection::linger() {
    stream_.async_read_some(boost::asio::buffer(discarded_),
                            [self = shared_from_this()](boost::beast::error_code error, std::size_t bytes) {
                                self->discarded_bytes_ += bytes;
                                if (!error && self->discarded_bytes_ < linger_bytes) self->linger();
                            });
}

}  // namespace meniscus::server
