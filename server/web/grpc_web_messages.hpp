// gRPC-Web on the wire: a byte of flags, four of length (big-endian), and a message; the last one carries the status.
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server {

using GrpcWebHeader = std::array<unsigned char, 5>;

/// bytes: the size of the message.
GrpcWebHeader grpc_web_header(std::size_t bytes);

/// Puts the one message of a request's body into `message`. Returns the status to answer with unless that is OK:
/// INVALID_ARGUMENT, or UNIMPLEMENTED for a compressed message.
grpc::Status grpc_web_request(std::string_view body, grpc::ByteBuffer& message);

/// The time that a client gives its call, as gRPC writes it: "100m" is 100 ms. Throws InvalidInput for anything else.
std::chrono::nanoseconds grpc_timeout(std::string_view text);

/// The message that ends an answer, with its header. metadata: names in lower case, values in printable ASCII; those
/// that are empty are left out.
std::string grpc_web_trailers(const grpc::Status& status,
                              const std::vector<std::pair<std::string, std::string>>& metadata = {});

}  // namespace meniscus::server
