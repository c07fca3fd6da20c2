#include "rpc/calls/byte_service.hpp"

#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_service_method.h>

#include <utility>

namespace meniscus::server {

ByteService::ByteService(std::string name) : name_(std::move(name)) {}

void ByteService::add(const std::string& method, Begin begin) {
    const std::string& path = paths_.emplace_back("/" + name_ + "/" + method);
    const int index = static_cast<int>(paths_.size()) - 1;
    AddMethod(new grpc::internal::RpcServiceMethod(path.c_str(), grpc::internal::RpcMethod::BIDI_STREAMING, nullptr));
    MarkMethodRawCallback(
        index, new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                   [begin = std::move(begin)](grpc::CallbackServerContext* context) { return begin(*context); }));
}

}  // namespace meniscus::server
