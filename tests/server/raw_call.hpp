// A call whose one request is up to the test: as gRPC's own clients never make them.
#pragma once

#include <grpcpp/generic/generic_stub.h>

#include <memory>
#include <string>

#include "connection/connection.hpp"

namespace meniscus::server::test {

/// A call that has begun. Each function waits for what it does.
class RawCall {
public:
    /// method: with its service, as "/meniscus.v1.SurfaceService/Watch". session: an id; empty for a call about none.
    RawCall(const client::Connection& connection, const std::string& method, const std::string& session = {})
        : stub_(connection.channel) {
        if (!session.empty()) client::add_session_id(context_, session);
        call_ = stub_.PrepareCall(&context_, method, &queue_);
        call_->StartCall(this);
        wait();
    }

    /// The request, after which nothing follows.
    void send(const grpc::ByteBuffer& message) {
        call_->WriteLast(message, {}, this);
        wait();
    }
    void send(const std::string& bytes) {
        const grpc::Slice slice(bytes);
        send(grpc::ByteBuffer(&slice, 1));
    }
    void send_no_more() {
        call_->WritesDone(this);
        wait();
    }
    void cancel() { context_.TryCancel(); }
    /// Reads to the end.
    grpc::Status end() {
        grpc::ByteBuffer answer;
        do call_->Read(&answer, this);
        while (wait());
        grpc::Status status;
        call_->Finish(&status, this);
        wait();
        return status;
    }

private:
    /// False if the call ended first.
    bool wait() {
        void* tag = nullptr;
        bool ok = false;
        return queue_.Next(&tag, &ok) && ok;
    }

    grpc::GenericStub stub_;
    grpc::ClientContext context_;
    grpc::CompletionQueue queue_;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

}  // namespace meniscus::server::test
