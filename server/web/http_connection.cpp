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
#include <utility>

namespace meniscus::server {

namespace http = boost::beast::http;

namespace {

/// What a client may still be sending while it is answered for the last time.
constexpr std::size_t linger_bytes = std::size_t{1} << 20;
constexpr auto linger_time = std::chrono::seconds(2);

}  // namespace

HttpConnection::HttpConnection(boost::asio::ip::tcp::socket socket, const Router& router, const HttpLimits& limits,
                               Observer observer)
    : stream_(std::move(socket)),
      router_(router),
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
    stream_.close();
}

void HttpConnection::read() {
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
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return refuse(405, fmt::format("{} is not allowed here; GET and HEAD are.\n", std::string(request.method_string())));
    if (!parser_->is_done()) return refuse(413, "A body is not taken here.\n");
    const boost::beast::string_view target = request.target();
    write(router_.answer({target.data(), target.size()}), request.keep_alive());
}

void HttpConnection::refuse(unsigned status, std::string sentence) {
    write({.status = status, .body = std::move(sentence)}, false);
}

void HttpConnection::write(Page page, bool keep_alive) {
    response_.emplace(http::int_to_status(page.status), 11);
    response_->set(http::field::content_type, page.content_type);
    response_->set(http::field::cache_control, "no-store");
    if (page.status == 405) response_->set(http::field::allow, "GET, HEAD");
    response_->keep_alive(keep_alive);
    response_->body() = std::move(page.body);
    response_->prepare_payload();
    serializer_.emplace(*response_);
    stream_.expires_after(limits_.patience);
    const auto done = [self = shared_from_this()](boost::beast::error_code error, std::size_t) { self->written(error); };
    if (parser_->get().method() == http::verb::head)
        http::async_write_header(stream_, *serializer_, done);
    else
        http::async_write(stream_, *serializer_, done);
}

void HttpConnection::written(boost::beast::error_code error) {
    if (error) return;
    if (!response_->keep_alive()) {
        stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
        stream_.expires_after(linger_time);
        linger();
        return;
    }
    observer_.answered(*this);
    read();
}

void HttpConnection::linger() {
    stream_.async_read_some(boost::asio::buffer(discarded_),
                            [self = shared_from_this()](boost::beast::error_code error, std::size_t bytes) {
                                self->discarded_bytes_ += bytes;
                                if (!error && self->discarded_bytes_ < linger_bytes) self->linger();
                            });
}

}  // namespace meniscus::server
