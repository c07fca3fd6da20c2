// Cancels a call that its client keeps waiting.
#pragma once

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace meniscus::server {

/// The time for the first message of a call. It carries only what its client knew when it called.
inline constexpr std::chrono::seconds first_message_patience{10};
/// The time for a client to take the messages under way to it, once no others follow.
inline constexpr std::chrono::seconds last_message_patience{5};

/// The timer of a reactor. One thread at a time, but for the calls of gRPC. It uses an alarm of gRPC, which needs no
/// thread and no lock that thousands of calls share; see Timer for the rest of the server.
class CancelTimer {
public:
    explicit CancelTimer(grpc::CallbackServerContext& context) : call_(std::make_shared<Call>(context)) {}

    /// Cancels the call after this time, unless it is stopped before. report: called first, if it comes to that.
    void start(std::chrono::milliseconds patience, std::function<void()> report = nullptr) {
        // A new alarm each time: one that has been set is not set again, only given up.
        alarm_ = std::make_unique<grpc::Alarm>();
        alarm_->Set(std::chrono::system_clock::now() + patience, [call = call_, report = std::move(report)](bool rang) {
            if (!rang) return;
            const std::lock_guard lock(call->mutex);
            if (call->context == nullptr) return;
            if (report) report();
            call->context->TryCancel();
        });
    }
    void stop() { alarm_.reset(); }
    bool runs() const noexcept { return alarm_ != nullptr; }
    /// From OnDone: gRPC frees the context. Not with a lock that OnCancel takes.
    void call_is_done() {
        const std::lock_guard lock(call_->mutex);
        call_->context = nullptr;
    }

private:
    struct Call {
        explicit Call(grpc::CallbackServerContext& c) : context(&c) {}

        std::mutex mutex;
        grpc::CallbackServerContext* context;  ///< none: the call is done
    };

    const std::shared_ptr<Call> call_;
    std::unique_ptr<grpc::Alarm> alarm_;
};

}  // namespace meniscus::server
