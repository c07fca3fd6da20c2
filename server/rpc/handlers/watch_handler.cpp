#include "rpc/handlers/watch_handler.hpp"

#include <fmt/format.h>
#include <grpcpp/alarm.h>

#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

#include "meniscus/v1/surface_service.pb.h"
#include "process/call_log.hpp"
#include "rpc/calls/caller.hpp"
#include "rpc/calls/cancel_timer.hpp"
#include "rpc/calls/one_request.hpp"
#include "rpc/calls/status.hpp"
#include "rpc/messages/codec_choice.hpp"
#include "rpc/messages/session_id.hpp"
#include "rpc/messages/watch_options.hpp"
#include "rpc/messages/wire_bytes.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

/// For a snapshot's mesh, and for its client to take each message of it: the place is another's then.
constexpr std::chrono::seconds snapshot_patience{20};

/// Receives its request, then sends what the watch has for it, message by message. Finishes after a cancellation as
/// soon as neither a read nor a write is under way. Request: names the session and the options.
template <class Request>
class WatchReactor final : public ByteReactor, public std::enable_shared_from_this<WatchReactor<Request>> {
public:
    WatchReactor(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals, ActiveCalls& calls,
                 grpc::CallbackServerContext& context)
        : active_(calls),
          registry_(registry),
          refusals_(refusals),
          context_(context),
          timer_(context),
          peer_(peer_of(authorizer, context)) {}

    void start(const Authorizer& authorizer) {
        self_ = this->shared_from_this();
        try {
            caller_ = admit(authorizer, context_, is_snapshot ? Action::snapshot : Action::watch);
            session_id_ = metadata_session_id(context_);
        } catch (...) {
            return refuse(std::current_exception());
        }
        timer_.start(first_message_patience);
        this->StartRead(&incoming_);
    }

    void OnReadDone(bool ok) override {
        timer_.stop();
        if (!ok && context_.IsCancelled()) return end(client_gone());
        try {
            open(received<Request>(ok, incoming_));
        } catch (...) {
            return refuse(std::current_exception());
        }
        {
            const std::lock_guard lock(mutex_);
            opened_ = true;
        }
        write();
    }

    void OnWriteDone(bool ok) override {
        if (ok) active_.progress();
        {
            const std::lock_guard lock(mutex_);
            writing_ = false;
            timer_.stop();
            if (!ok) canceled_ = true;
        }
        write();
    }

    void OnCancel() override {
        {
            const std::lock_guard lock(mutex_);
            canceled_ = true;
        }
        write();
    }

    void OnDone() override {
        timer_.call_is_done();
        if (watch_) {
            session_->close_watch(watch_);
            if (!is_snapshot) call_log.write({.session = session_id_}, "watcher from {} gone", peer_);
        }
        const auto self = std::move(self_);
    }

private:
    static constexpr bool is_snapshot = std::is_same_v<Request, v1::SnapshotRequest>;
    static constexpr bool sends_meshes = !std::is_same_v<Request, v1::WatchParticlesRequest>;
    static constexpr std::chrono::seconds message_patience = is_snapshot ? snapshot_patience : last_message_patience;

    void open(const Request& request) {
        using Look = SessionRegistry::Look;
        require_same_session(session_id_, request.session_id());
        const auto account = account_of(caller_, registry_);
        if (is_snapshot) place_ = registry_.snapshots().take(account);
        session_ = find_session(caller_, registry_, session_id_, is_snapshot ? Look::leaves_it_idle : Look::uses_it);
        const auto wake = [self = this->weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->write();
        };
        WatchOptions options = watch_options_of(request, session_->settings());
        CodecChoice codec;
        if constexpr (sends_meshes) {
            codec = codec_choice(request);
            options.format.codec = codec.codec;
        }
        watch_ = session_->open_watch(options, wake, account);
        if (is_snapshot)
            give_up_after(snapshot_patience);
        else
            call_log.write({.session = session_id_}, "watcher from {} connected", peer_);
        // At once: the client knows from here on that it misses no mesh. With metadata, as a refusal has none.
        context_.AddInitialMetadata("x-session-id", session_id_);
        if (is_snapshot) context_.AddInitialMetadata("x-session-instance", session_->instance());
        if (sends_meshes) announce(codec, context_);
        this->StartSendInitialMetadata();
    }

    void refuse(const std::exception_ptr& error) {
        refusals_.report(error, caller_.name, peer_);
        end(to_status(error));
    }

    /// Ends the call before the watch is open.
    void end(const grpc::Status& status) {
        const std::lock_guard lock(mutex_);
        finish(status);
    }

    void write() {
        const std::lock_guard lock(mutex_);
        if (!opened_ || finished_) return;
        if (writing_) {
            // Otherwise a client that takes nothing any more would keep what the session had.
            if (watch_->is_finished() && !timer_.runs()) timer_.start(message_patience);
            return;
        }
        if (canceled_) {
            finish(client_gone());
            return;
        }
        auto next = watch_->take();
        if (const auto* message = std::get_if<SharedMessage>(&next)) {
            registry_.metrics().message_sent(Metrics::Receiver::watcher, (*message)->size());
            outgoing_ = to_bytes(*message);
            writing_ = true;
            this->StartWrite(&outgoing_);
            if (watch_->is_finished()) timer_.start(message_patience);
        } else if (const auto* later = std::get_if<Watch::Later>(&next)) {
            write_at(later->at);
        } else if (const auto* end = std::get_if<Watch::End>(&next)) {
            if (const std::string reason = session_->end_reason(); !end->error && !reason.empty())
                context_.AddTrailingMetadata("x-session-end", reason);
            finish(to_status(end->error));
        }
    }

    /// A new alarm each time: one that has been set is not set again, only given up.
    void write_at(Watch::Clock::time_point time) {
        alarm_ = std::make_unique<grpc::Alarm>();
        alarm_->Set(std::chrono::system_clock::now() + (time - Watch::Clock::now()),
                    [self = this->weak_from_this()](bool rang) {
                        if (!rang) return;
                        if (const auto reactor = self.lock()) reactor->write();
                    });
    }

    /// The mesh may not come: what it is made of may have been overwritten, or there may be no memory for it.
    void give_up_after(std::chrono::seconds patience) {
        alarm_ = std::make_unique<grpc::Alarm>();
        alarm_->Set(std::chrono::system_clock::now() + patience, [self = this->weak_from_this()](bool rang) {
            if (!rang) return;
            if (const auto reactor = self.lock())
                reactor->watch_->finish(std::make_exception_ptr(
                    Refusal(Refusal::Kind::unavailable,
                            fmt::format("session {} has had no mesh to show for {} s: try again after its next frame",
                                        reactor->session_id_, snapshot_patience.count()))));
        });
    }

    void finish(const grpc::Status& status) {
        finished_ = true;
        this->Finish(status);
    }

    const ActiveCalls::Token active_;
    SessionRegistry& registry_;
    Refusals& refusals_;
    grpc::CallbackServerContext& context_;  ///< gRPC keeps it until OnDone
    CancelTimer timer_;                     ///< for the request, and for the last messages
    const std::string peer_;
    std::shared_ptr<WatchReactor> self_;  ///< until OnDone
    Caller caller_;
    std::string session_id_;
    grpc::ByteBuffer incoming_;
    SnapshotPlaces::Place place_;  ///< of a snapshot
    std::shared_ptr<Session> session_;
    std::shared_ptr<Watch> watch_;

    std::mutex mutex_;  ///< for what follows
    grpc::ByteBuffer outgoing_;
    std::unique_ptr<grpc::Alarm> alarm_;  ///< for the next frame, by the rate; of a snapshot: for the wait's end
    bool opened_ = false;                 ///< until then only the read ends the call
    bool writing_ = false;
    bool canceled_ = false;
    bool finished_ = false;
};

}  // namespace

template <class Request>
ByteReactor* start_watch(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                         ActiveCalls& calls, grpc::CallbackServerContext& context) {
    const auto reactor = std::make_shared<WatchReactor<Request>>(registry, authorizer, refusals, calls, context);
    reactor->start(authorizer);
    return reactor.get();
}

template ByteReactor* start_watch<v1::WatchRequest>(SessionRegistry&, const Authorizer&, Refusals&, ActiveCalls&,
                                                    grpc::CallbackServerContext&);
template ByteReactor* start_watch<v1::SnapshotRequest>(SessionRegistry&, const Authorizer&, Refusals&, ActiveCalls&,
                                                       grpc::CallbackServerContext&);
template ByteReactor* start_watch<v1::WatchParticlesRequest>(SessionRegistry&, const Authorizer&, Refusals&,
                                                             ActiveCalls&, grpc::CallbackServerContext&);

}  // namespace meniscus::server
