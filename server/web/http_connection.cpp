#include "web/http_connection.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace http = boost::beast::http;

namespace {

/// What a client may still be sending while it is answered for the last time.
constexpr std::size_t linger_bytes = std::size_t{1} << 20;
constexpr auto linger_time = std::chrono::seconds(2);
/// Of what a client sent, in what it is told.
constexpr std::size_t shown_bytes = 64;

std::string_view view(boost::beast::string_view text) {
    return {text.data(), text.size()};
}

/// To a browser that asks whether a page may make a call.
Page preflight_page(std::string_view origin) {
    return {.status = 204,
            .headers = {{"Access-Control-Allow-Origin", std::string(origin)},
                        {"Access-Control-Allow-Methods", "POST"},
                        {"Access-Control-Allow-Headers", "authorization, content-type, x-grpc-web, x-session-id"},
                        {"Access-Control-Max-Age", "600"},
                        {"Vary", "Origin"}}};
}

}  // namespace

HttpConnection::HttpConnection(boost::asio::ip::tcp::socket socket, boost::asio::io_context::executor_type executor,
                               const Router& router, const GrpcWeb& grpc_web, const HttpLimits& limits, Observer observer)
    : stream_(std::move(socket)),
      executor_(executor),
      router_(router),
      grpc_web_(grpc_web),
      limits_(limits),
      observer_(std::move(observer)),
      // Room for one header and for what a client sends ahead; more of that stays in the socket.
      buffer_(std::size_t{2} * limits.header_bytes) {}

HttpConnection::~HttpConnection() {
    observer_.gone(*this);
}

void HttpConnection::start() {
    read();
}

void HttpConnection::close() {
    if (exchange_) exchange_->cancel();
    stream_.close();
}

void HttpConnection::read() {
    call_parser_.reset();
    parser_.emplace();
    parser_->header_limit(limits_.header_bytes);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read: answer() refuses them
    // For the whole header: who sends it byte by byte gains nothing.
    stream_.expires_after(limits_.patience);
    http::async_read_header(stream_, buffer_, *parser_,
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
    const std::string_view path(request.target().data(), request.target().size());
    if (grpc_web_.serves(path)) {
        const std::string_view origin = view(request[http::field::origin]);
        if (!grpc_web_.origins.admits(origin, view(request[http::field::host])))
            return refuse(403, fmt::format("Pages of {} may not call this server; --web-origin allows them.\n", origin.substr(0, shown_bytes)));
        if (request.method() == http::verb::post) return receive_call();
        if (request.method() == http::verb::options) return write(preflight_page(origin), request.keep_alive());
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return refuse(405, fmt::format("{} is not allowed here; GET and HEAD are.\n", std::string(request.method_string())));
    if (!parser_->is_done()) return refuse(413, "A body is not taken here.\n");
    write(router_.answer(path, view(request[http::field::accept_encoding])), request.keep_alive());
}

void HttpConnection::receive_call() {
    const auto& request = parser_->get();
    if (const auto type = view(request[http::field::content_type]); type != "application/grpc-web+proto" && type != "application/grpc-web")
        return refuse(415, fmt::format("The content type is \"{}\"; application/grpc-web+proto is taken.\n", type.substr(0, shown_bytes)));
    if (parser_->content_length().value_or(0) > limits_.body_bytes)
        return refuse(413, fmt::format("The body has {} bytes; at most {} are taken.\n", *parser_->content_length(), limits_.body_bytes));
    call_parser_.emplace(std::move(*parser_));
    call_parser_->body_limit(limits_.body_bytes);
    chunks_ = 0;
    on_chunk_ = [this](std::uint64_t, boost::beast::string_view, boost::beast::error_code& error) {
        if (++chunks_ > limits_.body_chunks) error = http::make_error_code(http::error::body_limit);
    };
    call_parser_->on_chunk_header(on_chunk_);
    http::async_read(stream_, buffer_, *call_parser_,
                     [self = shared_from_this()](boost::beast::error_code error, std::size_t) { self->answer_call(error); });
}

void HttpConnection::answer_call(boost::beast::error_code error) {
    if (error == http::error::body_limit)
        return refuse(413, fmt::format("The body has more than {} bytes or {} chunks.\n", limits_.body_bytes, limits_.body_chunks));
    if (error.category() == http::make_error_code(http::error::bad_chunk).category() && error != http::error::partial_message)
        return refuse(400, fmt::format("This is no HTTP body: {}.\n", error.message()));
    if (error) return;  // gone, or too slow
    const auto exchange = std::make_shared<GrpcWebExchange>(
        stream_, executor_, limits_.patience, [self = shared_from_this()](GrpcWebExchange::Ending ending) { self->call_ended(ending); });
    try {
        exchange->start(grpc_web_, call_parser_->get());
        exchange_ = exchange;
    } catch (const InvalidInput& refusal) {
        refuse(400, fmt::format("{}.\n", refusal.what()));
    }
}

void HttpConnection::call_ended(GrpcWebExchange::Ending ending) {
    exchange_.reset();
    if (!ending.answered) return;
    if (!ending.keep_alive) return end_connection();
    observer_.answered(*this);
    read();
}

void HttpConnection::refuse(unsigned status, std::string sentence) {
    write({.status = status, .body = std::move(sentence)}, false);
}

void HttpConnection::write(Page page, bool keep_alive) {
    response_.emplace(http::int_to_status(page.status), 11);
    response_->set(http::field::content_type, page.content_type);
    response_->set(http::field::cache_control, page.cache_control);
    response_->set("X-Content-Type-Options", "nosniff");
    for (const auto& [name, value] : page.headers) response_->set(name, value);
    if (page.status == 405) response_->set(http::field::allow, "GET, HEAD");
    response_->keep_alive(keep_alive);
    response_->body() = std::move(page.body);
    response_->prepare_payload();
    serializer_.emplace(*response_);
    stream_.expires_after(limits_.patience);
    const auto done = [self = shared_from_this()](boost::beast::error_code error, std::size_t) { self->written(error); };
    if (!call_parser_ && parser_->get().method() == http::verb::head)
        http::async_write_header(stream_, *serializer_, done);
    else
        http::async_write(stream_, *serializer_, done);
}

void HttpConnection::written(boost::beast::error_code error) {
    if (error) return;
    if (!response_->keep_alive()) return end_connection();
    observer_.answered(*this);
    read();
}

void HttpConnection::end_connection() {
    boost::beast::error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(linger_time);
    linger();
}

void HttpConnection::linger() {
    stream_.async_read_some(boost::asio::buffer(discarded_),
                            [self = shared_from_this()](boost::beast::error_code error, std::size_t bytes) {
                                self->discarded_bytes_ += bytes;
                                if (!error && self->discarded_bytes_ < linger_bytes) self->linger();
                            });
}

}  // namespace meniscus::server
