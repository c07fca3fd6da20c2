// Tells clients which server answers: behind a proxy they see one address.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>

namespace meniscus::server {

/// Adds `x-server-instance`, as the contract has it, to every call: a name that is drawn here.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_instance_marker();

}  // namespace meniscus::server
