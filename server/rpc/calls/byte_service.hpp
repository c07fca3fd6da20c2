// A gRPC service whose calls begin with their metadata alone, and carry bytes.
//
// Where gRPC knows that a call has one request, it receives that whole before it announces the call, of any size and
// from any sender. Here every call is a stream both ways to gRPC, which is the same on the wire: its reactor asks for
// the caller, then for the request.
#pragma once

#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <deque>
#include <functional>
#include <string>

namespace meniscus::server {

using ByteReactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

class ByteService : public grpc::Service {
public:
    /// Returns the call's reactor, which owns itself until the call is done.
    using Begin = std::function<ByteReactor*(grpc::CallbackServerContext&)>;

protected:
    /// name: as in the contract, such as "meniscus.v1.SurfaceService".
    explicit ByteService(std::string name);

    /// method: as in the contract, such as "Watch". For constructors: gRPC asks once.
    void add(const std::string& method, Begin begin);

private:
    const std::string name_;
    std::deque<std::string> paths_;  ///< which gRPC refers to
};

}  // namespace meniscus::server
