// A call with one message of any size.
#pragma once

#include <grpcpp/grpcpp.h>

#include <string>

namespace meniscus::hostile {

/// How the call ended, on a connection of its own. method: with its service, as "/meniscus.v1.SurfaceService/Watch".
grpc::StatusCode send_one_message(const std::string& address, const std::string& method,
                                  const grpc::ByteBuffer& message, grpc_compression_algorithm compression);

}  // namespace meniscus::hostile
