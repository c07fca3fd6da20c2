// Messages as gRPC carries them.
#pragma once

#include <google/protobuf/message_lite.h>
#include <grpcpp/support/byte_buffer.h>

#include <string_view>

#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// Refers to the message's memory, which it keeps alive: no copy per receiver.
grpc::ByteBuffer to_bytes(const SharedMessage& message);

/// name: of the message's type. Throws InvalidInput for bytes that are not such a message.
void parse(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message, std::string_view name);

/// Throws as parse() does.
template <class Message>
Message parsed(const grpc::ByteBuffer& bytes) {
    grpc::ByteBuffer read(bytes);
    Message message;
    parse(read, message, Message::descriptor()->name());
    return message;
}

grpc::ByteBuffer serialized(const google::protobuf::MessageLite& message);

}  // namespace meniscus::server
