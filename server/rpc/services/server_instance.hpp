// Names the server that answers to its clients: behind a proxy they see one address.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>

namespace meniscus::server {

/// Adds the metadata `x-server-instance` of the contract to every call: a random name, drawn by this function.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_instance_marker();

}  // namespace meniscus::server
