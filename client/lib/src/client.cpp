#include "meniscus/client/client.hpp"

#include <algorithm>
#include <utility>

#include "connection/connection.hpp"
#include "conversion/settings_conversion.hpp"
#include "error_mapping.hpp"
#include "grpc/health/v1/health.grpc.pb.h"
#include "particle_watcher_impl.hpp"
#include "receiving/frame_statistics.hpp"
#include "recording_reader_impl.hpp"
#include "stream_impl.hpp"
#include "watcher_impl.hpp"

namespace meniscus::client {

namespace {

std::chrono::system_clock::time_point time_from_wire(std::int64_t microseconds) {
    using Time = std::chrono::system_clock::time_point;
    constexpr auto last = std::chrono::duration_cast<std::chrono::microseconds>(Time::max().time_since_epoch()).count();
    return Time(std::chrono::microseconds(std::clamp<std::int64_t>(microseconds, 0, last)));
}

SessionDescription from_wire(const v1::SessionDescription& wire) {
    SessionDescription description;
    description.name = wire.name();
    description.length_unit = wire.length_unit();
    if (wire.up_axis() == v1::UP_AXIS_X) description.up_axis = UpAxis::x;
    if (wire.up_axis() == v1::UP_AXIS_Y) description.up_axis = UpAxis::y;
    if (wire.up_axis() == v1::UP_AXIS_Z) description.up_axis = UpAxis::z;
    return description;
}

v1::UpAxis to_wire(UpAxis axis) {
    switch (axis) {
        case UpAxis::unspecified:
            return v1::UP_AXIS_UNSPECIFIED;
        case UpAxis::x:
            return v1::UP_AXIS_X;
        case UpAxis::y:
            return v1::UP_AXIS_Y;
        case UpAxis::z:
            return v1::UP_AXIS_Z;
    }
    return v1::UP_AXIS_UNSPECIFIED;
}

v1::SessionDescription to_wire(const SessionDescription& description) {
    v1::SessionDescription wire;
    wire.set_name(description.name);
    wire.set_up_axis(to_wire(description.up_axis));
    wire.set_length_unit(description.length_unit);
    return wire;
}

SessionInfo from_wire(const v1::Session& wire) {
    SessionInfo info;
    info.description = from_wire(wire.description());
    info.ephemeral = wire.ephemeral();
    info.created_at = time_from_wire(wire.created_at());
    info.id = wire.id();
    info.settings = conversion::from_wire(wire.settings());
    info.uploading = wire.uploading();
    info.watchers = wire.watchers();
    info.frames = wire.frames();
    if (wire.has_last_frame_index()) info.last_frame_index = wire.last_frame_index();
    info.owner = wire.owner();
    info.frames_dropped = wire.frames_dropped();
    info.frames_skipped = wire.frames_skipped();
    if (wire.has_wait()) {
        info.waits_for = wire.wait().reason() == v1::WAIT_REASON_DEVICE            ? SessionWait::device
                         : wire.wait().reason() == v1::WAIT_REASON_BYTES_IN_FLIGHT ? SessionWait::bytes_in_flight
                                                                                   : SessionWait::something_else;
        info.waits_for_session = wire.wait().session_id();
    }
    if (wire.has_last_frame()) info.last_frame = frame_statistics(wire.last_frame());
    return info;
}

RecordingInfo from_wire(const v1::Recording& wire) {
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

    /// One unary call about a session, or (no id) about none.
    template <class Stub, class Request, class Response>
    void call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
              const std::string& session_id, const Request& request, Response& response) const {
        grpc::ClientContext context;
        connection_->add_metadata(context, session_id);
        require_ok((stub.*method)(&context, request, &response), connection_->address);
    }

private:
    std::shared_ptr<Connection> connection_;  ///< shared with the streams, which may outlive the client
};

Client::Client(const std::string& address, const ConnectionOptions& options)
    : impl_(std::make_unique<Impl>(address, options)) {}
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;
Client::~Client() = default;

ServerInfo Client::server_info() {
    v1::GetServerInfoResponse response;
    impl_->call(*impl_->connection()->server, &v1::ServerService::Stub::GetServerInfo, {}, {}, response);
    ServerInfo info;
    info.version = response.version();
    info.backend = response.backend();
    info.device = response.device();
    info.backend_reason = response.backend_reason();
    info.threads = response.threads();
    info.max_sessions = response.limits().sessions();
    info.max_watchers_per_session = response.limits().watchers_per_session();
    info.max_particles_per_frame = response.limits().particles_per_frame();
    info.max_frame_work = response.limits().frame_work();
    info.max_frame_seconds = response.limits().frame_seconds();
    info.max_bytes_per_session = response.limits().bytes_per_session();
    info.max_device_bytes_per_session = response.limits().device_bytes_per_session();
    info.max_bytes_in_flight = response.limits().bytes_in_flight();
    info.max_frames_per_second = response.limits().frames_per_second();
    info.max_chunks_per_frame = response.limits().chunks_per_frame();
    info.max_idle_seconds = response.limits().idle_seconds();
    info.max_upload_seconds = response.limits().upload_seconds();
    info.min_upload_bytes_per_second = response.limits().upload_bytes_per_second();
    info.max_orphan_seconds = response.limits().orphan_seconds();
    info.max_total_bytes = response.limits().total_bytes();
    info.max_total_device_bytes = response.limits().total_device_bytes();
    info.max_idle_buffers_seconds = response.limits().idle_buffers_seconds();
    info.max_sessions_per_name = response.limits().sessions_per_name();
    info.max_watchers_per_name = response.limits().watchers_per_name();
    info.max_frames_per_second_per_name = response.limits().frames_per_second_per_name();
    info.max_bytes_in_flight_per_name = response.limits().bytes_in_flight_per_name();
    info.max_connections = response.limits().connections();
    info.max_connections_per_peer = response.limits().connections_per_peer();
    info.max_formats_per_session = response.limits().formats_per_session();
    info.max_recording_readers = response.limits().recording_readers();
    info.max_message_bytes = response.limits().message_bytes();
    info.codecs.assign(response.codecs().begin(), response.codecs().end());
    return info;
}

bool Client::serving() {
    const auto health = grpc::health::v1::Health::NewStub(impl_->connection()->channel);
    grpc::health::v1::HealthCheckResponse response;
    impl_->call(*health, &grpc::health::v1::Health::Stub::Check, {}, {}, response);
    return response.status() == grpc::health::v1::HealthCheckResponse::SERVING;
}

bool Client::create_session(const std::string& id, const Settings& settings, const SessionOptions& options) {
    v1::CreateSessionRequest request;
    request.set_id(id);
    *request.mutable_settings() = conversion::to_wire(settings);
    *request.mutable_description() = to_wire(options.description);
    request.set_ephemeral(options.ephemeral);
    v1::CreateSessionResponse response;
    impl_->call(*impl_->connection()->sessions, &v1::SessionService::Stub::CreateSession, id, request, response);
    return response.created();
}

SessionInfo Client::session(const std::string& id) {
    v1::GetSessionRequest request;
    request.set_id(id);
    v1::GetSessionResponse response;
    impl_->call(*impl_->connection()->sessions, &v1::SessionService::Stub::GetSession, id, request, response);
    return from_wire(response.session());
}

std::vector<SessionInfo> Client::sessions() {
    v1::ListSessionsResponse response;
    impl_->call(*impl_->connection()->sessions, &v1::SessionService::Stub::ListSessions, {}, {}, response);
    std::vector<SessionInfo> sessions;
    for (const v1::Session& session : response.sessions()) sessions.push_back(from_wire(session));
    return sessions;
}

void Client::delete_session(const std::string& id) {
    v1::DeleteSessionRequest request;
    request.set_id(id);
    v1::DeleteSessionResponse response;
    impl_->call(*impl_->connection()->sessions, &v1::SessionService::Stub::DeleteSession, id, request, response);
}

Stream Client::stream(const std::string& session_id, const StreamOptions& options) {
    return Stream(std::make_unique<Stream::Impl>(impl_->connection(), session_id, options));
}

Watcher Client::watch(const std::string& session_id, const WatchOptions& options) {
    return Watcher(std::make_unique<Watcher::Impl>(impl_->connection(), session_id, options));
}

ParticleWatcher Client::watch_particles(const std::string& session_id, std::uint64_t max_particles,
                                        std::chrono::milliseconds reconnect) {
    return ParticleWatcher(
        std::make_unique<ParticleWatcher::Impl>(impl_->connection(), session_id, max_particles, reconnect));
}

std::vector<RecordingInfo> Client::recordings() {
    v1::ListRecordingsResponse response;
    impl_->call(*impl_->connection()->recordings, &v1::RecordingService::Stub::ListRecordings, {}, {}, response);
    std::vector<RecordingInfo> recordings;
    for (const v1::Recording& recording : response.recordings()) recordings.push_back(from_wire(recording));
    return recordings;
}

RecordingReader Client::read_recording(const std::string& session_id, std::uint32_t number,
                                       const ReadOptions& options) {
    return RecordingReader(std::make_unique<RecordingReader::Impl>(impl_->connection(), session_id, number, options));
}

void Client::delete_recording(const std::string& session_id, std::uint32_t number) {
    v1::DeleteRecordingRequest request;
    request.set_session_id(session_id);
    request.set_number(number);
    v1::DeleteRecordingResponse response;
    impl_->call(*impl_->connection()->recordings, &v1::RecordingService::Stub::DeleteRecording, session_id, request,
                response);
}

}  // namespace meniscus::client
