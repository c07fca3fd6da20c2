// The request of a call that has one.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <cstddef>

#include "rpc/messages/wire_bytes.hpp"

namespace meniscus::server {

/// The most bytes of a request. The contract's requests have some hundred.
inline constexpr std::size_t max_request_bytes = 64 << 10;

/// came: what OnReadDone() receives. Throws InvalidInput for a call without a request, LimitExceeded for one too large.
void require_request(bool came, const grpc::ByteBuffer& bytes);

/// The request. Throws as require_request() does, and InvalidInput for bytes that are not such a message.
template <class Request>
Request received(bool came, const grpc::ByteBuffer& bytes) {
    require_request(came, bytes);
    return parsed<Request>(bytes);
}

}  // namespace meniscus::server
