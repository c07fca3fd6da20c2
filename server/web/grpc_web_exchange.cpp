#include "web/grpc_web_exchange.hpp"

#include <boost/asio/write.hpp>
#include <boost/beast/http/chunk_encode.hpp>
#include <boost/beast/http/write.hpp>
#include <string_view>
#include <utility>

#include "meniscus/error.hpp"
#include "security/web_peer.hpp"
#include "web/beast_text.hpp"
#include "web/call_metadata.hpp"
#include "web/origins.hpp"

namespace meniscus::server {

namespace http = boost::beast::http;

bool is_grpc_web(const http::fields& request) {
    const std::string_view type = view(request[http::field::content_type]);
    return type == "application/grpc-web+proto" || type == "application/grpc-web";
}

grpc::Status bridged_request(const GrpcWebRequest& request, BridgedCall::Request& call) {
    call.method = std::string(request.target());
    try {
        call.metadata = call_metadata(request, {"authorization", "x-session-id", forwarded_for_key});
        if (const auto timeout = request.find("grpc-timeout"); timeout != request.end())
            call.timeout = grpc_timeout(view(timeout->value()));
    } catch (const InvalidInput& refusal) {
        return {grpc::StatusCode::INVALID_ARGUMENT, refusal.what()};
    }
    return grpc_web_request(request.body(), call.message);
}

GrpcWebExchange::GrpcWebExchange(HttpStream& stream, std::shared_ptr<boost::asio::io_context> context,
                                 std::chrono::milliseconds patience, std::function<void(Ending)> ended)
    : stream_(stream), context_(std::move(context)), patience_(patience), ended_(std::move(ended)) {}

void GrpcWebExchange::start(const std::shared_ptr<grpc::Channel>& channel, const GrpcWebRequest& request,
                            BridgedCall::Request call) {
    const bool stream = is_stream(call.method);
    chunked_ = request.version() >= 11;
    keep_alive_ = chunked_ && request.keep_alive() && !stream;
    header_.emplace(header_for(request));
    call_ = std::make_shared<BridgedCall>(
        context_,
        BridgedCall::Receiver{
            .admitted = [self = shared_from_this()] { self->admitted(); },
            .message = [self = shared_from_this()](const grpc::ByteBuffer& received) { self->receive(received); },
            .end = [self = shared_from_this()](const grpc::Status& status) { self->finish(status); },
        });
    call_->start(channel, std::move(call));
    if (stream) watch_for_departure();
}

void GrpcWebExchange::cancel() {
    departed_ = true;
    if (call_ && !call_ended_) call_->cancel();
}

GrpcWebExchange::Header GrpcWebExchange::header_for(const GrpcWebRequest& request) const {
    Header header(http::status::ok, request.version());
    header.set(http::field::content_type, "application/grpc-web+proto");
    header.set(http::field::cache_control, "no-store");
    header.set("X-Content-Type-Options", "nosniff");
    // Proxies must pass each message on as it comes.
    header.set("X-Accel-Buffering", "no");
    for (const auto& [name, value] : cross_origin_headers(view(request[http::field::origin]))) header.set(name, value);
    header.keep_alive(keep_alive_);
    if (chunked_) header.chunked(true);
    return header;
}

void GrpcWebExchange::admitted() {
    if (serializer_) return;
    for (const char* name : {"x-codec", "x-codec-reason"})
        if (const std::string value = call_->initial_metadata(name); !value.empty()) header_->set(name, value);
    write_header();
}

void GrpcWebExchange::write_header() {
    if (serializer_ || departed_) return;
    serializer_.emplace(*header_);
    writing_ = true;
    stream_.tcp().expires_after(patience_);
    http::async_write_header(stream_, *serializer_,
                             [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
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

void GrpcWebExchange::receive(const grpc::ByteBuffer& message) {
    if (!message.Dump(&slices_).ok()) return cancel();
    message_header_ = grpc_web_header(message.Length());
    buffers_.assign(1, boost::asio::buffer(message_header_));
    for (const grpc::Slice& slice : slices_) buffers_.emplace_back(slice.begin(), slice.size());
    if (header_sent_)
        write(&GrpcWebExchange::await_message);
    else
        write_header();
}

void GrpcWebExchange::finish(const grpc::Status& status) {
    call_ended_ = true;
    if (departed_) return depart();
    trailers_ = grpc_web_trailers(status, {{"x-session-end", call_->trailing_metadata("x-session-end")}});
    buffers_.assign(1, boost::asio::buffer(trailers_));
    if (!header_sent_)
        write_header();
    else if (!writing_)
        write(&GrpcWebExchange::finished);
}

void GrpcWebExchange::write(Handler next) {
    writing_ = true;
    stream_.tcp().expires_after(patience_);
    const auto done = [self = shared_from_this(), next](boost::beast::error_code error, std::size_t) {
        self->written(error, next);
    };
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
        stream_.tcp().expires_after(patience_);
        boost::asio::async_write(stream_, http::make_chunk_last(),
                                 [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
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
    stream_.tcp().expires_never();
    // A client that sends more, to a stream that is the connection's last answer, is cut off as well: its departure
    // could not be noticed any more.
    stream_.async_read_some(boost::asio::buffer(unexpected_),
                            [self = shared_from_this()](boost::beast::error_code, std::size_t) {
                                self->watching_ = false;
                                self->departed_ = true;
                                self->depart();
                            });
}

/// Once nothing of the exchange is under way any more, the connection is given back.
void GrpcWebExchange::depart() {
    if (!call_ended_) cancel();
    if (watching_ || writing_) stream_.tcp().cancel();
    if (!call_ended_ || watching_ || writing_ || !call_) return;
    call_.reset();
    ended_({.answered = answered_, .keep_alive = keep_alive_});
}

}  // namespace meniscus::server
