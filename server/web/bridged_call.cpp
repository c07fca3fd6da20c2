#include "web/bridged_call.hpp"

#include <grpcpp/generic/generic_stub.h>

#include <boost/asio/post.hpp>

namespace meniscus::server {

BridgedCall::BridgedCall(boost::asio::io_context::executor_type executor, Receiver receiver)
    : executor_(executor), work_(executor), receiver_(std::move(receiver)) {}

void BridgedCall::start(const std::shared_ptr<grpc::Channel>& channel, const std::string& method, const Metadata& metadata,
                        grpc::ByteBuffer request) {
    self_ = shared_from_this();
    for (const auto& [name, value] : metadata) context_.AddMetadata(name, value);
    request_.Swap(&request);
    grpc::GenericStub(channel).PrepareBidiStreamingCall(&context_, method, {}, this);
    AddHold();
    held_ = true;
    // Before the request: within the process gRPC drops the answer of a unary handler that nobody waits for yet.
    read();
    StartWriteLast(&request_, {});
    StartCall();
}

void BridgedCall::read() {
    reading_ = true;
    StartRead(&message_);
}

void BridgedCall::cancel() {
    canceled_ = true;
    context_.TryCancel();
    if (held_ && !reading_) {
        held_ = false;
        RemoveHold();
    }
}

void BridgedCall::OnReadDone(bool ok) {
    boost::asio::post(executor_, [self = shared_from_this(), ok] { self->was_read(ok); });
}

void BridgedCall::was_read(bool ok) {
    reading_ = false;
    if (ok && !canceled_) {
        receiver_.message(std::move(message_));
    } else if (held_) {
        held_ = false;
        RemoveHold();
    }
}

void BridgedCall::OnDone(const grpc::Status& status) {
    boost::asio::post(executor_, [self = std::move(self_), status] { self->receiver_.end(status); });
}

}  // namespace meniscus::server
