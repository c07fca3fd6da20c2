// One HTTP connection: requests one after the other, each answered before the next is read.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "security/peer_address.hpp"
#include "web/grpc_web.hpp"
#include "web/grpc_web_exchange.hpp"
#include "web/http_limits.hpp"
#include "web/http_stream.hpp"
#include "web/latest_mesh.hpp"
#include "web/router.hpp"

namespace meniscus::server {

/// Lives while an operation of its socket is under way. Of one thread.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    /// answered: called after each answer; gone: at the end; may_stream: whether there is room for one more stream.
    struct Observer {
        std::function<void(HttpConnection&)> answered;
        std::function<void(HttpConnection&)> gone;
        std::function<bool()> may_stream;
    };
    /// The content that is served. All of it outlives the connection.
    struct Content {
        const Router& router;
        const GrpcWeb& grpc_web;
        boost::asio::thread_pool& worker;  ///< for what would hold the HTTP thread up
    };

    /// share: of the client's address. tls: none for HTTP alone.
    HttpConnection(boost::asio::ip::tcp::socket socket, const PeerAddress& share,
                   std::shared_ptr<boost::asio::ssl::context> tls, std::shared_ptr<boost::asio::io_context> context,
                   Content content, const HttpLimits& limits, Observer observer);
    ~HttpConnection();
    HttpConnection(const HttpConnection&) = delete;
    HttpConnection& operator=(const HttpConnection&) = delete;

    void start();
    /// Ends after the answer that is under way, or at once if there is none.
    void leave();
    /// Ends what is under way; gone() follows.
    void close();
    const PeerAddress& share() const noexcept { return share_; }
    /// Whether a stream is under way.
    bool streams() const noexcept { return streams_; }

private:
    using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;
    using CallParser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using RequestHeader = boost::beast::http::request_header<>;
    using Response = boost::beast::http::response<boost::beast::http::span_body<const char>>;

    void shake_hands();
    /// Answers a client that speaks HTTP on a port of TLS.
    void name_tls();
    void read();
    void receive(boost::beast::error_code error);
    void answer();
    /// Answers pages of other origins, which must be admitted, and their questions before a call. False if it has
    /// answered. methods: that are taken here.
    bool passes_origin(std::string_view methods);
    /// Reads the body of a gRPC-Web call, then answers it.
    void receive_call();
    /// The reason why no call can be made at this path; OK if it can.
    grpc::Status call_refusal(std::string_view path);
    void answer_call(boost::beast::error_code error);
    void answer_mesh();
    void answer_published();
    void write_mesh(Page page);
    void call_ended(GrpcWebExchange::Ending ending);
    /// Refuses a request after which no other can follow on this connection.
    void refuse(unsigned status, std::string sentence);
    /// Refuses a gRPC-Web call in the same way, with a status of gRPC.
    void refuse_call(const grpc::Status& status);
    /// The header of the request that is answered now.
    const RequestHeader& request_header() const;
    /// Counts a call that no handler sees.
    void count_refusal(grpc::StatusCode code) const;
    /// The other end, as gRPC writes those of its connections.
    std::string peer();
    void write(Page page, bool keep_alive);
    void write_rest();
    void written(boost::beast::error_code error);
    void end_connection();
    /// Ends the connection. Were it closed with bytes unread, the client might lose the answer.
    void linger();

    HttpStream stream_;
    const PeerAddress share_;
    const std::shared_ptr<boost::asio::io_context> context_;
    const Content content_;
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
    std::shared_ptr<LatestMesh> mesh_;           ///< likewise
    Page page_;                                  ///< whose body the response shows
    std::optional<Response> response_;
    std::optional<boost::beast::http::response_serializer<boost::beast::http::span_body<const char>>> serializer_;
    std::chrono::steady_clock::time_point written_by_;  ///< the answer, whole
    bool busy_ = false;                                 ///< from a request's last byte to its answer's
    bool is_call_ = false;                              ///< the request, of gRPC-Web
    bool is_mesh_ = false;                              ///< the request, for a session's mesh
    bool streams_ = false;
    bool leaving_ = false;
};

}  // namespace meniscus::server
