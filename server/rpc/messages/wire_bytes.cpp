#include "rpc/messages/wire_bytes.hpp"

#include <fmt/format.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <memory>

#include "meniscus/error.hpp"

namespace meniscus::server {

grpc::ByteBuffer to_bytes(const SharedMessage& message) {
    auto reference = std::make_unique<SharedMessage>(message);
    // gRPC only reads a slice, whatever its type says.
    const grpc::Slice slice(
        const_cast<char*>(message->data()), message->size(),
        [](void* kept) { delete static_cast<SharedMessage*>(kept); }, reference.release());
    return {&slice, 1};
}

void parse(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message, std::string_view name) {
    grpc::ProtoBufferReader reader(&bytes);
    if (!reader.status().ok() || !message.ParseFromZeroCopyStream(&reader))
        throw InvalidInput(fmt::format("a message of {} bytes is not a {}", bytes.Length(), name));
}

grpc::ByteBuffer serialized(const google::protobuf::MessageLite& message) {
    return to_bytes(std::make_shared<const std::string>(message.SerializeAsString()));
}

}  // namespace meniscus::server
