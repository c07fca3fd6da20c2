#include "meniscus/client/session.hpp"

#include <chrono>
#include <utility>

#include "meniscus/client/client.hpp"
#include "particle_watcher_impl.hpp"
#include "session_calls.hpp"
#include "session_impl.hpp"
#include "stream_impl.hpp"
#include "watcher_impl.hpp"

namespace meniscus::client {

namespace {

/// The time for each of two calls, so that a Session goes within a second, though nothing answers.
constexpr std::chrono::milliseconds farewell_time{400};

/// Ends it, unless it has ended, and somebody else has created another one of this id. limits: of each call.
void delete_own(const Connection& connection, const std::string& id, const MadeSessions& made,
                const CallLimits& limits) {
    try {
        if (made.has(session_info(connection, id, limits).created_at)) delete_session(connection, id, {}, limits);
    } catch (const ServerError& error) {
        if (error.code() != ErrorCode::not_found) throw;
    }
}

}  // namespace

Session::Impl::Impl(std::shared_ptr<Connection> connection, const Settings& settings, const OpenOptions& options)
    : connection_(std::move(connection)),
      id_(options.id.empty() ? new_session_id() : options.id),
      settings_(settings),
      options_{.description = options.description,
               .ephemeral = options.ephemeral,
               .stream_follows = options.stream_follows,
               .publish = options.publish},
      owned_(create(options.stop).created()) {}

Session::Impl::~Impl() {
    if (!owned_) return;
    try {
        delete_own(*connection_, id_, *made_, {.timeout = farewell_time});
    } catch (...) {
        // Nobody is left to see the error. The server ends an ephemeral session by itself.
    }
}

void Session::Impl::create_again(const std::stop_token& stop) {
    if (!owned_ || !options_.ephemeral) return;
    const v1::CreateSessionResponse response = create(stop);
    owned_ = made_->has(time_from_wire(response.session().created_at()));
}

v1::CreateSessionResponse Session::Impl::create(const std::stop_token& stop) {
    v1::CreateSessionResponse response =
        create_session(*connection_, id_, settings_, options_, {.timeout = connection_->timeout, .stop = stop});
    made_->note(response);
    return response;
}

void Session::Impl::end(const std::stop_token& stop) {
    if (!owned_) return;
    delete_own(*connection_, id_, *made_, {.timeout = connection_->timeout, .stop = stop});
    owned_ = false;
}

std::function<void()> Session::Impl::ending() const {
    if (!owned_) return [] {};
    return [connection = connection_, id = id_, made = made_] {
        delete_own(*connection, id, *made, {.timeout = connection->timeout});
    };
}

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

const std::string& Session::id() const noexcept {
    return impl_->id();
}

bool Session::is_owned() const noexcept {
    return impl_->is_owned();
}

SessionInfo Session::info(const std::stop_token& stop) {
    return session_info(*impl_->connection(), impl_->id(), {.timeout = impl_->connection()->timeout, .stop = stop});
}

Stream Session::stream(const StreamOptions& options) {
    impl_->create_again(options.stop);
    return Stream(Stream::Impl::open(impl_->connection(), impl_->id(), options, Stream::Impl::Uploads::particles,
                                     impl_->made(), NamedArrays(impl_->settings())));
}

Publisher Session::publish(const PublisherOptions& options) {
    impl_->create_again(options.stop);
    return {impl_->connection(), impl_->id(), options, impl_->made()};
}

Watcher Session::watch(const WatchOptions& options) {
    return Watcher(std::make_unique<Watcher::Impl>(impl_->connection(), impl_->id(), options));
}

ParticleWatcher Session::watch_particles(const ParticleWatchOptions& options) {
    return ParticleWatcher(std::make_unique<ParticleWatcher::Impl>(impl_->connection(), impl_->id(), options));
}

void Session::end(const std::stop_token& stop) {
    impl_->end(stop);
}

std::function<void()> Session::ending() const {
    return impl_->ending();
}

void Session::leave() noexcept {
    impl_->leave();
}

}  // namespace meniscus::client
