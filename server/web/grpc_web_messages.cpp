#include "web/grpc_web_messages.hpp"

#include <fmt/format.h>
#include <grpcpp/support/slice.h>

#include <cstdint>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

constexpr unsigned char trailers_flag = 0x80;

/// As gRPC wants messages of a status: printable ASCII, the rest and the percent sign as %XX.
std::string percent_encoded(const std::string& text) {
    std::string encoded;
    for (const char c : text) {
        if (c >= ' ' && c <= '~' && c != '%')
            encoded += c;
        else
            encoded += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return encoded;
}

}  // namespace

GrpcWebHeader grpc_web_header(std::size_t bytes) {
    const auto n = static_cast<std::uint32_t>(bytes);
    return {0, static_cast<unsigned char>(n >> 24), static_cast<unsigned char>(n >> 16 & 0xff),
            static_cast<unsigned char>(n >> 8 & 0xff), static_cast<unsigned char>(n & 0xff)};
}

grpc::ByteBuffer grpc_web_request(std::string_view body) {
    constexpr std::size_t header_bytes = GrpcWebHeader{}.size();
    if (body.size() < header_bytes)
        throw InvalidInput(fmt::format("the body has {} bytes; a gRPC-Web message has at least {}", body.size(), header_bytes));
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(body[i]); };
    if (byte(0) != 0) throw InvalidInput(fmt::format("the message has the flags {}; only 0 is taken, no compression", byte(0)));
    const std::uint32_t length = std::uint32_t{byte(1)} << 24 | std::uint32_t{byte(2)} << 16 | std::uint32_t{byte(3)} << 8 | byte(4);
    const std::string_view message = body.substr(header_bytes);
    if (message.size() != length)
        throw InvalidInput(fmt::format("the message announces {} bytes, but {} follow", length, message.size()));
    const grpc::Slice slice(message.data(), message.size());
    return {&slice, 1};
}

std::string grpc_web_trailers(const grpc::Status& status) {
    std::string text = fmt::format("grpc-status: {}\r\n", static_cast<int>(status.error_code()));
    if (!status.error_message().empty()) text += fmt::format("grpc-message: {}\r\n", percent_encoded(status.error_message()));
    GrpcWebHeader header = grpc_web_header(text.size());
    header[0] = trailers_flag;
    return std::string(header.begin(), header.end()) + text;
}

}  // namespace meniscus::server
