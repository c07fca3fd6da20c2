// Ends calls whose request does not end: gRPC 1.51 receives a message whole, however large, before it can be refused.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace meniscus::server {

/// The bytes that a connection has received; none once it has gone.
using ReceivedBytes = std::function<std::optional<std::uint64_t>()>;
/// By the peer, in gRPC's words. Empty for one that is not of TCP, which is of this machine.
using FindConnection = std::function<ReceivedBytes(const std::string& peer)>;

/// Of a connection that has received this many bytes beside what its calls were given, those calls are canceled that
/// have had no message yet. An interceptor, as the handlers see no part of a message. It looks every ten milliseconds,
/// and no call has a message for longer than first_message_patience without being canceled.
///
/// message_bytes: of one message, the least that may be under way. The requests of the other calls and the streams'
/// messages that are under way on the same connection are allowed for.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_request_guard(FindConnection find,
                                                                                          std::size_t message_bytes);

}  // namespace meniscus::server
