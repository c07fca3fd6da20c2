// A call from a browser to the handlers of native gRPC, over a channel within the process: the same errors, limits,
// tokens and metrics, and the same bytes.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/client_callback.h>
#include <grpcpp/support/status.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meniscus::server {

/// Used and answered on the context's one thread. Lives until its end has been reported.
class BridgedCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                          public std::enable_shared_from_this<BridgedCall> {
public:
    /// One of these answers start() and each read(): a message, or the end, which comes once.
    struct Receiver {
        std::function<void()> admitted;  ///< the handler has admitted the call; at most once
        std::function<void(const grpc::ByteBuffer& message)> message;
        std::function<void(const grpc::Status& status)> end;
    };
    struct Request {
        std::string method;  ///< as "/package.Service/Method"
        /// Must be what gRPC takes: lower-case names, values in printable ASCII.
        std::vector<std::pair<std::string, std::string>> metadata;
        std::optional<std::chrono::nanoseconds> timeout;
        grpc::ByteBuffer message;
    };

    BridgedCall(std::shared_ptr<boost::asio::io_context> context, Receiver receiver);

    void start(const std::shared_ptr<grpc::Channel>& channel, Request request);
    /// Call it only once the read before was answered: a client that does not take its messages holds the handler up,
    /// as in native gRPC.
    void read();
    /// What the handler has begun its answer with, once it has admitted the call; empty: nothing of this name.
    std::string initial_metadata(const char* name) const;
    /// What the handler has ended its answer with, after the end; likewise.
    std::string trailing_metadata(const char* name) const;
    /// The end follows, as canceled.
    void cancel();

    // The functions of the reactor, on threads of gRPC.
    void OnReadInitialMetadataDone(bool ok) override;
    void OnReadDone(bool ok) override;
    void OnDone(const grpc::Status& status) override;

private:
    void was_read(bool ok);

    const std::shared_ptr<boost::asio::io_context> io_;
    const boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
    const Receiver receiver_;
    grpc::ClientContext context_;
    grpc::ByteBuffer request_;
    grpc::ByteBuffer message_;
    std::shared_ptr<BridgedCall> self_;  ///< until OnDone
    bool reading_ = false;
    bool held_ = false;  ///< OnDone waits until nothing is read any more
    bool canceled_ = false;
};

}  // namespace meniscus::server
