#include "meniscus/client/client.hpp"

#include <utility>

#include "connection/connection.hpp"
#include "grpc/health/v1/health.grpc.pb.h"
#include "particle_watcher_impl.hpp"
#include "receiving/session_description.hpp"
#include "recording_reader_impl.hpp"
#include "rows/message_rows.hpp"
#include "session_calls.hpp"
#include "session_impl.hpp"
#include "snapshot.hpp"
#include "stream_impl.hpp"
#include "unary_call.hpp"
#include "watcher_impl.hpp"

namespace meniscus::client {

namespace {

RecordingInfo recording_info(const v1::Recording& wire) {
    RecordingInfo info;
    info.session_id = wire.session_id();
    info.number = wire.number();
    info.owner = wire.owner();
    info.description = from_wire(wire.description());
    info.started_at = time_from_wire(wire.started_at());
    info.frames = wire.frames();
    if (wire.has_first_frame_index()) info.first_frame_index = wire.first_frame_index();
    if (wire.has_last_frame_index()) info.last_frame_index = wire.last_frame_index();
    info.bytes = wire.bytes();
    info.being_written = wire.being_written();
    info.damaged = wire.damaged();
    return info;
}

}  // namespace

class Client::Impl {
public:
    Impl(const std::string& address, const ConnectionOptions& options)
        : connection_(std::make_shared<Connection>(address, options)) {}

    const std::shared_ptr<Connection>& connection() const noexcept { return connection_; }

    CallLimits limits(const std::stop_token& stop) const { return {.timeout = connection_->timeout, .stop = stop}; }
    /// One unary call about a session, or (no id) about none.
    template <class Stub, class Request, class Response>
    void call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
              const std::string& session_id, const Request& request, Response& response,
              const std::stop_token& stop) const {
        client::call(*connection_, stub, method, session_id, request, response, limits(stop));
    }

private:
    std::shared_ptr<Connection> connection_;  ///< shared with the streams, which may outlive the client
};

Client::Client(const std::string& address, const ConnectionOptions& options)
    : impl_(std::make_unique<Impl>(address, options)) {}
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;
Client::~Client() = default;

ServerInfo Client::server_info(const std::stop_token& stop) {
    v1::GetServerInfoResponse response;
    impl_->call(*impl_->connection()->server, &v1::ServerService::Stub::GetServerInfo, {}, {}, response, stop);
    ServerInfo info;
    info.version = response.version();
    info.backend = response.backend();
    info.device = response.device();
    info.backend_reason = response.backend_reason();
    info.threads = response.threads();
    ServerInfo::rows([&](std::string_view name, auto member, const Facts& facts) {
        constexpr std::size_t prefix = 4;  // max_ and min_
        const v1::Limits& limits = response.limits();
        rows::read(limits, rows::MessageField(limits, name.substr(prefix)), facts, name, info.*member, {});
    });
    info.codecs.assign(response.codecs().begin(), response.codecs().end());
    info.publishes = response.publishes();
    info.checks_published = response.checks_published();
    return info;
}

bool Client::serving(const std::stop_token& stop) {
    const auto health = grpc::health::v1::Health::NewStub(impl_->connection()->channel);
    grpc::health::v1::HealthCheckResponse response;
    impl_->call(*health, &grpc::health::v1::Health::Stub::Check, {}, {}, response, stop);
    return response.status() == grpc::health::v1::HealthCheckResponse::SERVING;
}

bool Client::create_session(const std::string& id, const Settings& settings, const SessionOptions& options,
                            const std::stop_token& stop) {
    return client::create_session(*impl_->connection(), id, settings, options, impl_->limits(stop)).created();
}

SessionInfo Client::session(const std::string& id, const std::stop_token& stop) {
    return session_info(*impl_->connection(), id, impl_->limits(stop));
}

std::vector<SessionInfo> Client::sessions(const std::stop_token& stop) {
    v1::ListSessionsResponse response;
    impl_->call(*impl_->connection()->sessions, &v1::SessionService::Stub::ListSessions, {}, {}, response, stop);
    std::vector<SessionInfo> sessions;
    for (const v1::Session& session : response.sessions()) sessions.push_back(from_wire(session));
    return sessions;
}

void Client::delete_session(const std::string& id, const DeleteOptions& options, const std::stop_token& stop) {
    client::delete_session(*impl_->connection(), id, options, impl_->limits(stop));
}

Session Client::open_session(const Settings& settings, const OpenOptions& options) {
    return Session(std::make_unique<Session::Impl>(impl_->connection(), settings, options));
}

Stream Client::stream(const std::string& session_id, const StreamOptions& options) {
    return Stream(Stream::Impl::open(impl_->connection(), session_id, options));
}

Publisher Client::publish(const std::string& session_id, const PublisherOptions& options) {
    return {impl_->connection(), session_id, options};
}

Watcher Client::watch(const std::string& session_id, const WatchOptions& options) {
    return Watcher(std::make_unique<Watcher::Impl>(impl_->connection(), session_id, options));
}

std::optional<ReceivedFrame> Client::snapshot(const std::string& session_id, const SnapshotOptions& options) {
    return take_snapshot(*impl_->connection(), session_id, options);
}

ParticleWatcher Client::watch_particles(const std::string& session_id, const ParticleWatchOptions& options) {
    return ParticleWatcher(std::make_unique<ParticleWatcher::Impl>(impl_->connection(), session_id, options));
}

ParticleWatcher Client::watch_particles(const std::string& session_id, std::uint64_t max_particles,
                                        std::chrono::milliseconds reconnect) {
    return watch_particles(session_id, {.max_particles = max_particles, .reconnect = reconnect});
}

std::vector<RecordingInfo> Client::recordings(const std::stop_token& stop) {
    v1::ListRecordingsResponse response;
    impl_->call(*impl_->connection()->recordings, &v1::RecordingService::Stub::ListRecordings, {}, {}, response, stop);
    std::vector<RecordingInfo> recordings;
    for (const v1::Recording& recording : response.recordings()) recordings.push_back(recording_info(recording));
    return recordings;
}

RecordingReader Client::read_recording(const std::string& session_id, std::uint32_t number,
                                       const ReadOptions& options) {
    return RecordingReader(std::make_unique<RecordingReader::Impl>(impl_->connection(), session_id, number, options));
}

void Client::delete_recording(const std::string& session_id, std::uint32_t number, const std::stop_token& stop) {
    v1::DeleteRecordingRequest request;
    request.set_session_id(session_id);
    request.set_number(number);
    v1::DeleteRecordingResponse response;
    impl_->call(*impl_->connection()->recordings, &v1::RecordingService::Stub::DeleteRecording, session_id, request,
                response, stop);
}

}  // namespace meniscus::client
