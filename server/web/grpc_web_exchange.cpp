#include "web/grpc_web_exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/write.hpp>
#include <boost/beast/http/chunk_encode.hpp>
#include <boost/beast/http/write.hpp>
#include <string_view>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace http = boost::beast::http;

BridgedCall::Metadata call_metadata(const GrpcWebRequest& request) {
    BridgedCall::Metadata metadata;
    for (const std::string_view name : {"authorization", "x-session-id"}) {
        const auto [first, last] = request.equal_range(boost::beast::string_view(name.data(), name.size()));
        for (auto field = first; field != last; ++field) {
            std::string value(field->value());
            if (!std::ranges::all_of(value, [](char c) { return c >= ' ' && c <= '~'; }))
                throw InvalidInput(fmt::format("the header {} has characters other than printable ASCII", name));
            metadata.emplace_back(name, std::move(value));
        }
    }
    return metadata;
}

GrpcWebExchange::GrpcWebExchange(boost::beast::tcp_stream& stream, boost::asio::io_context::executor_type executor,
                                 std::chrono::milliseconds patience, std::function<void(Ending)> ended)
    : stream_(stream), executor_(executor), patience_(patience), ended_(std::move(ended)) {}

void GrpcWebExchange::start(const GrpcWeb& service, const GrpcWebRequest& request) {
    const std::string target(request.target());
    grpc::ByteBuffer message = grpc_web_request(request.body());
    const BridgedCall::Metadata metadata = call_metadata(request);
    chunked_ = request.version() >= 11;
    keep_alive_ = chunked_ && request.keep_alive() && !is_stream(target);
    call_ = std::make_shared<BridgedCall>(
        executor_, BridgedCall::Receiver{
                       .message = [self = shared_from_this()](grpc::ByteBuffer received) { self->receive(std::move(received)); },
                       .end = [self = shared_from_this()](const grpc::Status& status) { self->finish(status); },
                   });
    call_->start(service.channel, target, metadata, std::move(message));
    if (is_stream(target)) watch_for_departure();
    write_header(request);
}

void GrpcWebExchange::cancel() {
    departed_ = true;
    if (call_ && !call_ended_) call_->cancel();
}

void GrpcWebExchange::write_header(const GrpcWebRequest& request) {
    header_.emplace(http::status::ok, request.version());
    header_->set(http::field::content_type, "application/grpc-web+proto");
    header_->set(http::field::cache_control, "no-store");
    header_->set("X-Content-Type-Options", "nosniff");
    // Proxies must pass each message on as it comes.
    header_->set("X-Accel-Buffering", "no");
    if (const auto origin = request[http::field::origin]; !origin.empty()) {
        header_->set(http::field::access_control_allow_origin, origin);
        header_->set(http::field::vary, "Origin");
    }
    header_->keep_alive(keep_alive_);
    if (chunked_) header_->chunked(true);
    serializer_.emplace(*header_);
    writing_ = true;
    stream_.expires_after(patience_);
    http::async_write_header(stream_, *serializer_, [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
        self->written(error, &GrpcWebExchange::header_written);
    });
}

void GrpcWebExchange::header_written() {
    header_sent_ = true;
    if (call_ended_)
        write(&GrpcWebExchange::finished);
    else if (!buffers_.empty())
        write(&GrpcWebExchange::await_message);
}

void GrpcWebExchange::await_message() {
    slices_.clear();
    call_->read();
}

void GrpcWebExchange::receive(grpc::ByteBuffer message) {
    if (!message.Dump(&slices_).ok()) return cancel();
    message_header_ = grpc_web_header(message.Length());
    buffers_.assign(1, boost::asio::buffer(message_header_));
    for (const grpc::Slice& slice : slices_) buffers_.emplace_back(slice.begin(), slice.size());
    if (header_sent_) write(&GrpcWebExchange::await_message);
}

void GrpcWebExchange::finish(const grpc::Status& status) {
    call_ended_ = true;
    if (departed_) return depart();
    trailers_ = grpc_web_trailers(status);
    buffers_.assign(1, boost::asio::buffer(trailers_));
    if (!writing_) write(&GrpcWebExchange::finished);
}

void GrpcWebExchange::write(Handler next) {
    writing_ = true;
    stream_.expires_after(patience_);
    const auto done = [self = shared_from_this(), next](boost::beast::error_code error, std::size_t) { self->written(error, next); };
    if (chunked_)
        boost::asio::async_write(stream_, http::make_chunk(buffers_), done);
    else
        boost::asio::async_write(stream_, buffers_, done);
}

void GrpcWebExchange::written(boost::beast::error_code error, Handler next) {
    writing_ = false;
    if (error || departed_) {
        departed_ = true;
        return depart();
    }
    (this->*next)();
}

void GrpcWebExchange::finished() {
    if (chunked_ && !answered_) {
        answered_ = true;
        writing_ = true;
        stream_.expires_after(patience_);
        boost::asio::async_write(stream_, http::make_chunk_last(), [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
            self->written(error, &GrpcWebExchange::finished);
        });
        return;
    }
    answered_ = true;
    departed_ = true;
    depart();
}

void GrpcWebExchange::watch_for_departure() {
    watching_ = true;
    stream_.expires_never();
    stream_.async_read_some(boost::asio::buffer(discarded_), [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
        self->watching_ = false;
        // More than the request is not taken from a client that receives a stream: its connection ends with the answer.
        if (error) self->departed_ = true;
        if (self->departed_) self->depart();
    });
}

/// Once nothing of the exchange is under way any more, the connection is given back.
void GrpcWebExchange::depart() {
    if (!call_ended_) cancel();
    if (watching_ || writing_) stream_.cancel();
    if (!call_ended_ || watching_ || writing_ || !call_) return;
    call_.reset();
    ended_({.answered = answered_, .keep_alive = keep_alive_});
}

}  // namespace meniscus::server
