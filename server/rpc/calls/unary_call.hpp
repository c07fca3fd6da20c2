// A call with one request and one answer.
#pragma once

#include <google/protobuf/message_lite.h>

#include <exception>
#include <functional>

#include "rpc/calls/byte_service.hpp"
#include "rpc/calls/caller.hpp"
#include "rpc/calls/cancel_timer.hpp"
#include "rpc/calls/refusals.hpp"
#include "rpc/messages/wire_bytes.hpp"
#include "security/authorizer.hpp"

namespace meniscus::server {

/// Receives the request once the caller may make the call. Owns itself until the call is done.
class UnaryCall final : public ByteReactor {
public:
    /// Given the call with its request, gives it its answer or refusal, at once or later. What it throws is a refusal.
    using Handle = std::function<void(UnaryCall&)>;

    static UnaryCall* start(const Authorizer& authorizer, Refusals& refusals, Action action, Handle handle,
                            grpc::CallbackServerContext& context);

    const grpc::CallbackServerContext& context() const { return context_; }
    const Caller& caller() const { return caller_; }
    /// The other end, as peer_of() names it.
    std::string peer() const { return peer_of(authorizer_, context_); }
    /// Throws InvalidInput for bytes that are not such a message.
    template <class Request>
    Request request() const {
        return parsed<Request>(request_);
    }

    // One of these, once; the call may be gone when they return.
    void answer(const google::protobuf::MessageLite& response) { answer(serialized(response)); }
    void answer(const grpc::ByteBuffer& response);
    void refuse(const std::exception_ptr& error);

    /// Whether nobody waits for the answer any more; then the call is done.
    bool finish_if_canceled();

    void OnReadDone(bool ok) override;
    void OnDone() override;

private:
    UnaryCall(const Authorizer& authorizer, Refusals& refusals, Handle handle, grpc::CallbackServerContext& context);

    const Authorizer& authorizer_;
    Refusals& refusals_;
    const Handle handle_;
    grpc::CallbackServerContext& context_;  ///< gRPC keeps it until OnDone
    CancelTimer first_message_;
    Caller caller_;
    grpc::ByteBuffer request_;
    grpc::ByteBuffer response_;
};

}  // namespace meniscus::server
