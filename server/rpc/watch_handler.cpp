#include "rpc/watch_handler.hpp"

#include <grpcpp/alarm.h>

#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "log.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "rpc/caller.hpp"
#include "rpc/session_id.hpp"
#include "rpc/status.hpp"
#include "rpc/watch_wishes.hpp"
#include "rpc/wire_bytes.hpp"

namespace meniscus::server {

namespace {

/// Sends what the watch has for it, message by message. Finishes after a cancellation as soon as no write is under way.
class WatchReactor final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                           public std::enable_shared_from_this<WatchReactor> {
public:
    WatchReactor(Metrics& metrics, ActiveCalls& calls, const grpc::CallbackServerContext& context)
        : metrics_(metrics), active_(calls), peer_(peer_of(context)) {}

    /// Request: what names the session and the wishes.
    template <class Request>
    void start(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
               grpc::CallbackServerContext& context, const grpc::ByteBuffer& request) {
        self_ = shared_from_this();
        Caller caller;
        try {
            caller = admit(authorizer, context, Action::watch);
            session_id_ = metadata_session_id(context);
            const auto message = parsed<Request>(request);
            require_same_session(session_id_, message.session_id());
            session_ = find_session(caller, registry, session_id_);
            const auto wake = [self = weak_from_this()] {
                if (const auto reactor = self.lock()) reactor->write();
            };
            watch_ = session_->open_watch(watch_wishes_of(message, session_->settings()), wake,
                                          account_of(caller, registry));
        } catch (...) {
            refusals.report(std::current_exception(), caller.name, peer_);
            const std::lock_guard lock(mutex_);
            finish(to_status(std::current_exception()));
            return;
        }
        log_info({.session = session_id_}, "watcher from {} connected", peer_);
        // At once: the client knows from here on that it misses no mesh. With metadata, as a refusal has none.
        context.AddInitialMetadata("x-session-id", session_id_);
        StartSendInitialMetadata();
        write();
    }

    void OnWriteDone(bool ok) override {
        if (ok) active_.progress();
        {
            const std::lock_guard lock(mutex_);
            writing_ = false;
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
        if (watch_) {
            session_->close_watch(watch_);
            log_info({.session = session_id_}, "watcher from {} gone", peer_);
        }
        const auto self = std::move(self_);
    }

private:
    void write() {
        const std::lock_guard lock(mutex_);
        if (writing_ || finished_) return;
        if (canceled_) {
            finish({grpc::StatusCode::CANCELLED, "the client has gone"});
            return;
        }
        auto next = watch_->take();
        if (const auto* message = std::get_if<SharedMessage>(&next)) {
            metrics_.message_sent(Metrics::Receiver::watcher, (*message)->size());
            outgoing_ = to_bytes(*message);
            writing_ = true;
            StartWrite(&outgoing_);
        } else if (const auto* later = std::get_if<Watch::Later>(&next)) {
            write_at(later->at);
        } else if (const auto* end = std::get_if<Watch::End>(&next)) {
            finish(to_status(end->error));
        }
    }

    /// A new alarm each time: one that has been set is not set again, only given up.
    void write_at(Watch::Clock::time_point time) {
        alarm_ = std::make_unique<grpc::Alarm>();
        alarm_->Set(std::chrono::system_clock::now() + (time - Watch::Clock::now()),
                    [self = weak_from_this()](bool rang) {
                        if (!rang) return;
                        if (const auto reactor = self.lock()) reactor->write();
                    });
    }

    void finish(const grpc::Status& status) {
        finished_ = true;
        Finish(status);
    }

    Metrics& metrics_;
    const ActiveCalls::Token active_;
    const std::string peer_;
    std::shared_ptr<WatchReactor> self_;  ///< until OnDone
    std::string session_id_;
    std::shared_ptr<Session> session_;
    std::shared_ptr<Watch> watch_;

    std::mutex mutex_;  ///< for what follows
    grpc::ByteBuffer outgoing_;
    std::unique_ptr<grpc::Alarm> alarm_;  ///< for the next frame, by the rate
    bool writing_ = false;
    bool canceled_ = false;
    bool finished_ = false;
};

}  // namespace

template <class Request>
grpc::ServerWriteReactor<grpc::ByteBuffer>* start_watch(SessionRegistry& registry, const Authorizer& authorizer,
                                                        Refusals& refusals, ActiveCalls& calls,
                                                        grpc::CallbackServerContext& context,
                                                        const grpc::ByteBuffer& request) {
    const auto reactor = std::make_shared<WatchReactor>(registry.metrics(), calls, context);
    reactor->start<Request>(registry, authorizer, refusals, context, request);
    return reactor.get();
}

template grpc::ServerWriteReactor<grpc::ByteBuffer>* start_watch<v1::WatchRequest>(SessionRegistry&, const Authorizer&,
                                                                                   Refusals&, ActiveCalls&,
                                                                                   grpc::CallbackServerContext&,
                                                                                   const grpc::ByteBuffer&);
template grpc::ServerWriteReactor<grpc::ByteBuffer>* start_watch<v1::WatchParticlesRequest>(
    SessionRegistry&, const Authorizer&, Refusals&, ActiveCalls&, grpc::CallbackServerContext&,
    const grpc::ByteBuffer&);

}  // namespace meniscus::server
