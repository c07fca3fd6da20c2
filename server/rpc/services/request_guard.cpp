#include "rpc/services/request_guard.hpp"

#include <fmt/format.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string_view>
#include <thread>
#include <unordered_set>
#include <utility>
#include <vector>

#include "process/freed_memory.hpp"
#include "process/line_limit.hpp"
#include "rpc/calls/cancel_timer.hpp"
#include "rpc/calls/one_request.hpp"

namespace meniscus::server {

namespace {

constexpr std::string_view own_package = "/meniscus.v1.";
constexpr std::string_view stream_method = "/meniscus.v1.SurfaceService/Stream";

/// What one uploading stream may hold back: a message, and the window that gRPC opens on a fast connection.
constexpr std::uint64_t bytes_of_an_upload = std::uint64_t{64} << 20;
/// The header of a call.
constexpr std::uint64_t bytes_of_a_header = 4096;

struct GuardedConnection {
    explicit GuardedConnection(ReceivedBytes bytes) : received(std::move(bytes)) {}

    const ReceivedBytes received;
    std::atomic<std::uint64_t> given{0};  ///< bytes of the messages that its calls have had

    // With the guard's lock held.
    std::uint64_t begun = 0;  ///< calls, so far
    unsigned waiting = 0;     ///< of them without their first message
    unsigned uploads = 0;     ///< and those that go on sending
};

class GuardedCall;

class RequestGuard {
public:
    RequestGuard(FindConnection find, std::size_t message_bytes)
        : find_(std::move(find)), message_bytes_(message_bytes), thread_([this] { run(); }) {}
    ~RequestGuard() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        begun_.notify_all();
        stopped_.notify_all();
        thread_.join();
    }
    RequestGuard(const RequestGuard&) = delete;
    RequestGuard& operator=(const RequestGuard&) = delete;

    void begin(GuardedCall& call);
    void have_first(GuardedCall& call);
    void end(GuardedCall& call);
    /// A call of this peer has gone.
    void forget(const std::string& peer);

private:
    static constexpr std::chrono::milliseconds interval{10};
    /// Until gRPC has freed what it held.
    static constexpr std::chrono::seconds until_freed{1};

    void run();
    /// With the lock held.
    void look();
    void leave(GuardedCall& call);

    const FindConnection find_;
    const std::size_t message_bytes_;
    LineLimit lines_;  ///< of the log

    std::mutex mutex_;                 ///< for what follows
    std::condition_variable begun_;    ///< for the thread that has no call to look at
    std::condition_variable stopped_;  ///< and for that which looks now and then: calls that begin do not wake it
    std::map<std::string, std::weak_ptr<GuardedConnection>> connections_;  ///< by their peers
    std::unordered_set<GuardedCall*> waiting_;                             ///< for their first message
    std::optional<std::chrono::steady_clock::time_point> trim_at_;
    bool stopping_ = false;

    std::thread thread_;
};

class GuardedCall final : public grpc::experimental::Interceptor {
public:
    GuardedCall(RequestGuard& guard, grpc::experimental::ServerRpcInfo& info)
        : info_(info), is_upload_(info.method() == stream_method), guard_(guard) {}
    ~GuardedCall() override {
        if (!connection_) return;
        guard_.end(*this);
        connection_.reset();
        guard_.forget(peer_);
    }

    void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
        using HookPoint = grpc::experimental::InterceptionHookPoints;
        if (methods->QueryInterceptionHookPoint(HookPoint::POST_RECV_INITIAL_METADATA)) guard_.begin(*this);
        if (connection_ && methods->QueryInterceptionHookPoint(HookPoint::POST_RECV_MESSAGE)) {
            const auto* const message = static_cast<const grpc::ByteBuffer*>(methods->GetRecvMessage());
            if (message != nullptr) connection_->given += message->Length();
            if (!std::exchange(has_first_, true)) guard_.have_first(*this);
        }
        // A call is there until its handler finishes it, and each does.
        if (methods->QueryInterceptionHookPoint(HookPoint::PRE_SEND_STATUS)) guard_.end(*this);
        methods->Proceed();
    }

private:
    friend class RequestGuard;

    grpc::experimental::ServerRpcInfo& info_;
    const bool is_upload_;
    RequestGuard& guard_;
    bool has_first_ = false;

    // Set once, before the handler sees the call.
    std::string peer_;
    std::shared_ptr<GuardedConnection> connection_;  ///< none: it is not guarded
    std::optional<CancelTimer> cancel_;
    std::uint64_t received_ = 0;  ///< by the connection, as the call began; likewise:
    std::uint64_t given_ = 0;
    std::uint64_t begun_ = 0;

    // With the guard's lock held.
    bool waits_ = false;
    bool uploads_ = false;
    bool ended_ = false;
};

void RequestGuard::begin(GuardedCall& call) {
    grpc::ServerContextBase& context = *call.info_.server_context();
    const std::string peer = context.peer();
    {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<GuardedConnection> connection = connections_[peer].lock();
        std::optional<std::uint64_t> bytes = connection ? connection->received() : std::nullopt;
        // Where there are none, it has gone, and its peer may have come again while calls of it are still ending.
        if (!bytes) {
            ReceivedBytes received = find_(peer);
            if (!received) {
                connections_.erase(peer);
                return;
            }
            connection = std::make_shared<GuardedConnection>(std::move(received));
            connections_[peer] = connection;
            bytes = connection->received();
        }
        call.received_ = bytes.value_or(0);
        call.given_ = connection->given;
        call.begun_ = ++connection->begun;
        call.cancel_.emplace(static_cast<grpc::CallbackServerContext&>(context));
        call.waits_ = true;
        ++connection->waiting;
        call.peer_ = peer;
        call.connection_ = std::move(connection);
        waiting_.insert(&call);
    }
    begun_.notify_all();
}

void RequestGuard::leave(GuardedCall& call) {
    if (!std::exchange(call.waits_, false)) return;
    waiting_.erase(&call);
    --call.connection_->waiting;
}

void RequestGuard::have_first(GuardedCall& call) {
    const std::lock_guard lock(mutex_);
    leave(call);
    call.uploads_ = call.is_upload_ && !call.ended_;
    if (call.uploads_) ++call.connection_->uploads;
}

void RequestGuard::end(GuardedCall& call) {
    if (!call.connection_) return;
    {
        const std::lock_guard lock(mutex_);
        call.ended_ = true;
        leave(call);
        if (std::exchange(call.uploads_, false)) --call.connection_->uploads;
    }
    call.cancel_->call_is_done();
}

void RequestGuard::forget(const std::string& peer) {
    const std::lock_guard lock(mutex_);
    if (const auto found = connections_.find(peer); found != connections_.end() && found->second.expired())
        connections_.erase(found);
}

void RequestGuard::run() {
    using Clock = std::chrono::steady_clock;
    std::unique_lock lock(mutex_);
    Clock::duration taken{};  // by the last look
    while (!stopping_) {
        if (trim_at_ && Clock::now() >= *trim_at_) {
            trim_at_.reset();
            lock.unlock();
            return_free_pages();
            lock.lock();
        }
        const auto has_work = [this] { return stopping_ || !waiting_.empty(); };
        if (!waiting_.empty()) {
            // However many connections there are, a fifth of a processor at most.
            stopped_.wait_for(lock, std::max<Clock::duration>(interval, 4 * taken), [this] { return stopping_; });
            const auto began = Clock::now();
            look();
            taken = Clock::now() - began;
        } else if (trim_at_) {
            begun_.wait_until(lock, *trim_at_, has_work);
        } else {
            begun_.wait(lock, has_work);
        }
    }
}

void RequestGuard::look() {
    std::map<const GuardedConnection*, std::optional<std::uint64_t>> received;
    std::vector<GuardedCall*> too_large;
    for (GuardedCall* const waiting : waiting_) {
        GuardedCall& call = *waiting;
        const GuardedConnection& connection = *call.connection_;
        const auto [now, is_new] = received.try_emplace(&connection);
        if (is_new) now->second = connection.received();
        if (!now->second) continue;  // the call ends with it
        // Frames and TLS add little to messages.
        const std::uint64_t given = connection.given - call.given_;
        const std::uint64_t allowed = message_bytes_ + given + given / 16 + max_request_bytes * connection.waiting +
                                      bytes_of_an_upload * connection.uploads +
                                      bytes_of_a_header * (connection.begun - call.begun_);
        if (*now->second - std::min(*now->second, call.received_) <= allowed) continue;
        if (const auto left = lines_.pass())
            spdlog::warn(
                "a request of {} is canceled that has not come whole within {} bytes of its connection; {} are "
                "taken{}",
                call.peer_, *now->second - call.received_, max_request_bytes, left_out(*left));
        too_large.push_back(&call);
    }
    if (!too_large.empty()) trim_at_ = std::chrono::steady_clock::now() + until_freed;
    for (GuardedCall* const call : too_large) {
        leave(*call);
        // Later, by a thread of gRPC: what a call does as it is canceled would ask for the lock.
        call->cancel_->start(std::chrono::milliseconds(1));
    }
}

class GuardedCalls final : public grpc::experimental::ServerInterceptorFactoryInterface {
public:
    GuardedCalls(FindConnection find, std::size_t message_bytes) : guard_(std::move(find), message_bytes) {}

    grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* call) override {
        // Health checks are not received, and those of gRPC's own services few.
        if (!std::string_view(call->method()).starts_with(own_package)) return nullptr;
        return new GuardedCall(guard_, *call);  // owned by the call
    }

private:
    RequestGuard guard_;
};

}  // namespace

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_request_guard(FindConnection find,
                                                                                          std::size_t message_bytes) {
    return std::make_unique<GuardedCalls>(std::move(find), message_bytes);
}

}  // namespace meniscus::server
