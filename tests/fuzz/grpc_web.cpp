#include "web/grpc_web_messages.hpp"

#include <chrono>

#include "support.hpp"
#include "web/accepts_gzip.hpp"
#include "web/origins.hpp"

namespace meniscus::fuzz {

void grpc_web(Bytes bytes) {
    Front front(bytes);
    const Bytes header = front.piece(front.number(1));
    const Bytes body = front.rest();

    grpc::ByteBuffer message;
    if (server::grpc_web_request(body, message).ok()) {
        const server::GrpcWebHeader framed = server::grpc_web_header(message.Length());
        require(body.substr(0, framed.size()) == Bytes(reinterpret_cast<const char*>(framed.data()), framed.size()),
                "a message that is taken has the header that it would be sent with");
    }
    may_refuse([&] {
        const auto time = server::grpc_timeout(header);
        require(time >= std::chrono::nanoseconds(0) && time <= std::chrono::hours(24), "a call's time is bounded");
    });
    may_refuse([&] {
        const server::AllowedOrigins origins({std::string(header)}, body.substr(0, 64));
        require(origins.admits(header, "other"), "an origin that is allowed is admitted");
    });
    const server::AllowedOrigins origins;
    origins.knows_host(header);
    origins.admits(header, body.substr(0, 64));
    server::accepts_gzip(header);
    const std::string trailers = server::grpc_web_trailers({grpc::StatusCode::UNKNOWN, std::string(body)});
    require(trailers.find('\0', server::GrpcWebHeader{}.size()) == std::string::npos,
            "a status's message is printable");
}

Seeds grpc_web_seeds() {
    const auto seed = [](const std::string& header, const std::string& body) {
        return number_bytes(static_cast<std::uint32_t>(header.size()), 1) + header + body;
    };
    return {seed("100m", std::string(5, '\0')), seed("99999999H", std::string("\0\0\0\0\3abc", 8)),
            seed("https://viewer.example:8443", std::string("\1\0\0\0\0", 5)), seed("[::1]:9464", "[::1]:9464"),
            seed("br, gzip;q=0.0", std::string("\0\xff\xff\xff\xff", 5))};
}

}  // namespace meniscus::fuzz
