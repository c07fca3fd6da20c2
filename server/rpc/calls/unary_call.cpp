#include "rpc/calls/unary_call.hpp"

#include <utility>

#include "rpc/calls/one_request.hpp"
#include "rpc/calls/status.hpp"

namespace meniscus::server {

UnaryCall* UnaryCall::start(const Authorizer& authorizer, Refusals& refusals, Action action, Handle handle,
                            grpc::CallbackServerContext& context) {
    auto* call = new UnaryCall(authorizer, refusals, std::move(handle), context);
    try {
        call->caller_ = admit(authorizer, context, action);
        call->first_message_.start(first_message_patience);
        call->StartRead(&call->request_);
    } catch (...) {
        call->refuse(std::current_exception());
    }
    return call;
}

UnaryCall::UnaryCall(const Authorizer& authorizer, Refusals& refusals, Handle handle,
                     grpc::CallbackServerContext& context)
    : authorizer_(authorizer),
      refusals_(refusals),
      handle_(std::move(handle)),
      context_(context),
      first_message_(context) {}

void UnaryCall::OnReadDone(bool ok) {
    first_message_.stop();
    if (!ok && context_.IsCancelled()) return Finish(client_gone());
    try {
        require_request(ok, request_);
        handle_(*this);
    } catch (...) {
        refuse(std::current_exception());
    }
}

void UnaryCall::OnDone() {
    first_message_.call_is_done();
    delete this;
}

void UnaryCall::answer(const grpc::ByteBuffer& response) {
    response_ = response;
    StartWriteAndFinish(&response_, {}, grpc::Status::OK);
}

void UnaryCall::refuse(const std::exception_ptr& error) {
    refusals_.report(error, caller_.name, peer());
    Finish(to_status(error));
}

bool UnaryCall::finish_if_canceled() {
    if (!context_.IsCancelled()) return false;
    Finish(client_gone());
    return true;
}

}  // namespace meniscus::server
