// One call of Stream or Publish: frames out, responses in.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/sync_stream.h>

#include <memory>
#include <string>

#include "connection/connection.hpp"
#include "pushed_frame.hpp"

namespace meniscus::client {

/// How the call begins.
struct UploadOpening {
    const char* method = nullptr;  ///< path of Stream or Publish
    std::string request;           ///< the first, serialized
    std::string request_again;     ///< the same of a call that goes on where one before has broken off
    bool sends_parts = false;
};

/// One thread may send while another reads.
class UploadCall {
public:
    /// again: whether it goes on where one before has broken off.
    UploadCall(std::shared_ptr<Connection> connection, const std::string& session_id, const UploadOpening& opening,
               bool again);

    /// False once the call has ended: read() and then finish() say why. Copies no particles: gRPC refers to the
    /// frame's bytes, and keeps them, until they are on the wire.
    bool send(const PushedFrame& frame);
    void no_more_frames();
    /// Between two frames, and the last that is sent: the session goes on with another server.
    void move();

    /// Waits until the server has accepted the call, or the call has ended. As client::accepted_by; before the first
    /// read().
    std::string accepted_by();
    /// False once there is nothing more to read.
    bool read(v1::StreamResponse& response);
    grpc::Status finish();
    /// The call's context, for the metadata of its end.
    const grpc::ClientContext& context() const { return context_; }

    /// Cancels the call, from any thread.
    void cancel();

private:
    /// request: serialized.
    bool send(const std::string& request, grpc::WriteOptions options);

    const std::shared_ptr<Connection> connection_;
    const bool sends_parts_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, v1::StreamResponse>> call_;
};

}  // namespace meniscus::client
