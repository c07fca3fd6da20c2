// One gRPC-Web request and its answer on an HTTP connection: chunked, or up to the connection's end for HTTP/1.0.
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "web/bridged_call.hpp"
#include "web/grpc_web.hpp"
#include "web/grpc_web_messages.hpp"
#include "web/http_stream.hpp"

namespace meniscus::server {

using GrpcWebRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Whether a request is one of gRPC-Web, by its content type.
bool is_grpc_web(const boost::beast::http::fields& request);

/// Puts what the request asks of the handler into `call`. Returns the status to answer with unless that is OK.
grpc::Status bridged_request(const GrpcWebRequest& request, BridgedCall::Request& call);

class GrpcWebExchange : public std::enable_shared_from_this<GrpcWebExchange> {
public:
    struct Ending {
        bool answered = false;    ///< whether the answer is complete
        bool keep_alive = false;  ///< whether another request may follow
    };

    /// patience: how long the client may take for one message. The stream stays in use until `ended` is called; nothing
    /// happens after that.
    GrpcWebExchange(HttpStream& stream, std::shared_ptr<boost::asio::io_context> context,
                    std::chrono::milliseconds patience, std::function<void(Ending)> ended);

    void start(const std::shared_ptr<grpc::Channel>& channel, const GrpcWebRequest& request, BridgedCall::Request call);
    /// Ends the call; `ended` follows.
    void cancel();

private:
    using Header = boost::beast::http::response<boost::beast::http::empty_body>;
    using Handler = void (GrpcWebExchange::*)();

    Header header_for(const GrpcWebRequest& request) const;
    void admitted();
    /// Called once the handler has admitted the call, or ended it: a client that has the header misses nothing after
    /// it.
    void write_header();
    void header_written();
    void await_message();
    void receive(const grpc::ByteBuffer& message);
    void finish(const grpc::Status& status);
    void finished();
    /// Writes buffers_, then goes on with `next`.
    void write(Handler next);
    void written(boost::beast::error_code error, Handler next);
    /// A client that leaves while nothing is sent to it is not noticed otherwise.
    void watch_for_departure();
    void depart();

    HttpStream& stream_;
    const std::shared_ptr<boost::asio::io_context> context_;
    const std::chrono::milliseconds patience_;
    const std::function<void(Ending)> ended_;
    std::shared_ptr<BridgedCall> call_;
    std::optional<Header> header_;
    std::optional<boost::beast::http::response_serializer<boost::beast::http::empty_body>> serializer_;
    GrpcWebHeader message_header_{};
    std::vector<grpc::Slice> slices_;  ///< of the message under way
    std::string trailers_;
    std::vector<boost::asio::const_buffer> buffers_;
    std::array<char, 1> unexpected_{};
    bool chunked_ = true;
    bool keep_alive_ = false;
    bool watching_ = false;  ///< a read is pending
    bool writing_ = false;
    bool call_ended_ = false;
    bool header_sent_ = false;
    bool answered_ = false;
    bool departed_ = false;
};

}  // namespace meniscus::server
