#include "web/bridged_call.hpp"

#include <grpcpp/generic/generic_stub.h>

#include <boost/asio/post.hpp>
#include <map>

namespace meniscus::server {

namespace {

std::string value_in(const std::multimap<grpc::string_ref, grpc::string_ref>& metadata, const char* name) {
    const auto found = metadata.find(name);
    return found == metadata.end() ? std::string() : std::string(found->second.data(), found->second.size());
}

}  // namespace

BridgedCall::BridgedCall(std::shared_ptr<boost::asio::io_context> context, Receiver receiver)
    : io_(std::move(context)), work_(io_->get_executor()), receiver_(std::move(receiver)) {}

void BridgedCall::start(const std::shared_ptr<grpc::Channel>& channel, Request request) {
    self_ = shared_from_this();
    for (const auto& [name, value] : request.metadata) context_.AddMetadata(name, value);
    if (request.timeout)
        context_.set_deadline(std::chrono::system_clock::now() +
                              std::chrono::duration_cast<std::chrono::system_clock::duration>(*request.timeout));
    request_.Swap(&request.message);
    grpc::GenericStub(channel).PrepareBidiStreamingCall(&context_, request.method, {}, this);
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

std::string BridgedCall::initial_metadata(const char* name) const {
    return value_in(context_.GetServerInitialMetadata(), name);
}

std::string BridgedCall::trailing_metadata(const char* name) const {
    return value_in(context_.GetServerTrailingMetadata(), name);
}

void BridgedCall::cancel() {
    canceled_ = true;
    context_.TryCancel();
    if (held_ && !reading_) {
        held_ = false;
        RemoveHold();
    }
}

void BridgedCall::OnReadInitialMetadataDone(bool ok) {
    if (ok) boost::asio::post(*io_, [self = shared_from_this()] { self->receiver_.admitted(); });
}

void BridgedCall::OnReadDone(bool ok) {
    boost::asio::post(*io_, [self = shared_from_this(), ok] { self->was_read(ok); });
}

void BridgedCall::was_read(bool ok) {
    reading_ = false;
    if (ok && !canceled_) {
        receiver_.message(message_);
    } else if (held_) {
        held_ = false;
        RemoveHold();
    }
}

void BridgedCall::OnDone(const grpc::Status& status) {
    // The context outlives post(), though this may be the last that its thread waits for.
    const auto io = io_;
    boost::asio::post(*io, [self = std::move(self_), status] { self->receiver_.end(status); });
}

}  // namespace meniscus::server
