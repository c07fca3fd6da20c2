#include "web/grpc_web_messages.hpp"

#include <fmt/format.h>
#include <grpcpp/support/slice.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

constexpr unsigned char compressed_flag = 0x01;
constexpr unsigned char trailers_flag = 0x80;

/// The text as gRPC wants messages of a status: printable ASCII, the rest and the percent sign as %XX.
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

grpc::Status grpc_web_request(std::string_view body, grpc::ByteBuffer& message) {
    const auto malformed = [](const std::string& text) {
        return grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, text);
    };
    constexpr std::size_t header_bytes = GrpcWebHeader{}.size();
    if (body.size() < header_bytes)
        return malformed(
            fmt::format("the body has {} bytes; a gRPC-Web message has at least {}", body.size(), header_bytes));
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(body[i]); };
    if (byte(0) == compressed_flag)
        return {grpc::StatusCode::UNIMPLEMENTED, "the message is compressed; send it as it is"};
    if (byte(0) != 0) return malformed(fmt::format("the message has the flags {}; only 0 is taken", byte(0)));
    const std::uint32_t length =
        std::uint32_t{byte(1)} << 24 | std::uint32_t{byte(2)} << 16 | std::uint32_t{byte(3)} << 8 | byte(4);
    const std::string_view bytes = body.substr(header_bytes);
    if (bytes.size() != length)
        return malformed(fmt::format("the message announces {} bytes, but {} follow", length, bytes.size()));
    const grpc::Slice slice(bytes.data(), bytes.size());
    message = grpc::ByteBuffer(&slice, 1);
    return grpc::Status::OK;
}

std::chrono::nanoseconds grpc_timeout(std::string_view text) {
    using std::chrono::nanoseconds;
    static constexpr std::array<std::pair<char, nanoseconds>, 6> units{{{'H', std::chrono::hours(1)},
                                                                        {'M', std::chrono::minutes(1)},
                                                                        {'S', std::chrono::seconds(1)},
                                                                        {'m', std::chrono::milliseconds(1)},
                                                                        {'u', std::chrono::microseconds(1)},
                                                                        {'n', nanoseconds(1)}}};
    constexpr std::size_t most_digits = 8;
    const std::size_t digits = text.empty() ? 0 : text.size() - 1;
    const auto* unit = std::ranges::find(units, digits == 0 ? '\0' : text.back(), &std::pair<char, nanoseconds>::first);
    std::int64_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + digits, count);
    if (unit == units.end() || digits > most_digits || error != std::errc() || end != text.data() + digits || count < 0)
        throw InvalidInput("grpc-timeout must be 1 to 8 digits and one of H, M, S, m, u, n");
    // Longer than a day is as good as none, and cannot overflow.
    constexpr nanoseconds most = std::chrono::hours(24);
    return count > most / unit->second ? most : count * unit->second;
}

std::string grpc_web_trailers(const grpc::Status& status,
                              const std::vector<std::pair<std::string, std::string>>& metadata) {
    std::string text = fmt::format("grpc-status: {}\r\n", static_cast<int>(status.error_code()));
    if (!status.error_message().empty())
        text += fmt::format("grpc-message: {}\r\n", percent_encoded(status.error_message()));
    for (const auto& [name, value] : metadata)
        if (!value.empty()) text += fmt::format("{}: {}\r\n", name, value);
    GrpcWebHeader header = grpc_web_header(text.size());
    header[0] = trailers_flag;
    return std::string(header.begin(), header.end()) + text;
}

}  // namespace meniscus::server
