#include "session_calls.hpp"

#include <algorithm>

#include "conversion/settings_conversion.hpp"
#include "receiving/frame_statistics.hpp"
#include "receiving/session_description.hpp"
#include "unary_call.hpp"

namespace meniscus::client {

std::chrono::system_clock::time_point time_from_wire(std::int64_t microseconds) {
    using Time = std::chrono::system_clock::time_point;
    constexpr auto last = std::chrono::duration_cast<std::chrono::microseconds>(Time::max().time_since_epoch()).count();
    return Time(std::chrono::microseconds(std::clamp<std::int64_t>(microseconds, 0, last)));
}

SessionInfo from_wire(const v1::Session& wire) {
    SessionInfo info;
    info.description = from_wire(wire.description());
    info.ephemeral = wire.ephemeral();
    info.published = wire.published();
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

v1::CreateSessionResponse create_session(const Connection& connection, const std::string& id, const Settings& settings,
                                         const SessionOptions& options, const CallLimits& limits) {
    v1::CreateSessionRequest request;
    request.set_id(id);
    *request.mutable_settings() = conversion::to_wire(settings);
    *request.mutable_description() = to_wire(options.description);
    request.set_ephemeral(options.ephemeral);
    request.set_stream_follows(options.stream_follows);
    request.set_publish(options.publish);
    v1::CreateSessionResponse response;
    call(connection, *connection.sessions, &v1::SessionService::Stub::CreateSession, id, request, response, limits);
    return response;
}

SessionInfo session_info(const Connection& connection, const std::string& id, const CallLimits& limits) {
    v1::GetSessionRequest request;
    request.set_id(id);
    v1::GetSessionResponse response;
    call(connection, *connection.sessions, &v1::SessionService::Stub::GetSession, id, request, response, limits);
    return from_wire(response.session());
}

void delete_session(const Connection& connection, const std::string& id, const DeleteOptions& options,
                    const CallLimits& limits) {
    v1::DeleteSessionRequest request;
    request.set_id(id);
    request.set_unpublish(options.unpublish);
    v1::DeleteSessionResponse response;
    call(connection, *connection.sessions, &v1::SessionService::Stub::DeleteSession, id, request, response, limits);
}

}  // namespace meniscus::client
