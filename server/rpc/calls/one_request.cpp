#include "rpc/calls/one_request.hpp"

#include <fmt/format.h>

#include "meniscus/error.hpp"

namespace meniscus::server {

void require_request(bool came, const grpc::ByteBuffer& bytes) {
    if (!came) throw InvalidInput("the call ended before its request: send one message");
    if (bytes.Length() > max_request_bytes)
        throw LimitExceeded(
            fmt::format("the request has {} bytes; at most {} are taken", bytes.Length(), max_request_bytes));
}

}  // namespace meniscus::server
