// One HTTP connection: requests one after the other, each answered before the next is read.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "web/grpc_web.hpp"
#include "web/grpc_web_exchange.hpp"
#include "web/http_limits.hpp"
#include "web/router.hpp"

namespace meniscus::server {

/// Lives while an operation of its socket is under way. Of one thread.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    /// answered: called after each answer; gone: at the end.
    struct Observer {
        std::function<void(HttpConnection&)> answered;
        std::function<void(HttpConnection&)> gone;
    };

    HttpConnection(boost::asio::ip::tcp::socket socket, boost::asio::io_context::executor_type executor, const Router& router,
                   const GrpcWeb& grpc_web, const HttpLimits& limits, Observer observer);
    ~HttpConnection();
    HttpConnection(const HttpConnection&) = delete;
    HttpConnection& operator=(const HttpConnection&) = delete;

    void start();
    /// Ends what is under way; gone() follows.
    void close();

private:
    using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;
    using CallParser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using Response = boost::beast::http::response<boost::beast::http::string_body>;

    void read();
    void receive(boost::beast::error_code error);
    void answer();
    /// Of a gRPC-Web call: its body, then what it asks for.
    void receive_call();
    void answer_call(boost::beast::error_code error);
    void call_ended(GrpcWebExchange::Ending ending);
    /// Refuses what cannot be followed by another request on this connection.
    void refuse(unsigned status, std::string sentence);
    void write(Page page, bool keep_alive);
    void written(boost::beast::error_code error);
    void end_connection();
    /// Ends the connection. Were it closed with bytes unread, the client might lose the answer.
    void linger();

    boost::beast::tcp_stream stream_;
    const boost::asio::io_context::executor_type executor_;
    const Router& router_;
    const GrpcWeb& grpc_web_;
    const HttpLimits limits_;
    const Observer observer_;
    boost::beast::flat_buffer buffer_;
    std::array<char, 4096> discarded_{};
    std::size_t discarded_bytes_ = 0;
    std::optional<Parser> parser_;
    std::optional<CallParser> call_parser_;
    std::uint32_t chunks_ = 0;  ///< of the call's body
    std::function<void(std::uint64_t, boost::beast::string_view, boost::beast::error_code&)> on_chunk_;
    std::shared_ptr<GrpcWebExchange> exchange_;  ///< the call that is answered now
    std::optional<Response> response_;
    std::optional<boost::beast::http::response_serializer<boost::beast::http::string_body>> serializer_;
};

}  // namespace meniscus::server
