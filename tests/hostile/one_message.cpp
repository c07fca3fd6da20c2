#include "one_message.hpp"

#include <grpcpp/generic/generic_stub.h>

#include <chrono>

namespace meniscus::hostile {

grpc::StatusCode send_one_message(const std::string& address, const std::string& method,
                                  const grpc::ByteBuffer& message, grpc_compression_algorithm compression) {
    grpc::ChannelArguments arguments;
    arguments.SetMaxSendMessageSize(-1);
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    grpc::GenericStub stub(grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
    grpc::ClientContext context;
    context.set_compression_algorithm(compression);
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(2));
    grpc::CompletionQueue queue;
    const auto call = stub.PrepareUnaryCall(&context, method, message, &queue);
    call->StartCall();
    grpc::ByteBuffer answer;
    grpc::Status status;
    call->Finish(&answer, &status, nullptr);
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
    return status.error_code();
}

}  // namespace meniscus::hostile
