#include "rpc/messages/session_message.hpp"

#include <chrono>

#include "conversion/settings_conversion.hpp"
#include "sessions/sending/statistics_message.hpp"

namespace meniscus::server {

namespace {

v1::WaitReason to_wire(SessionWait wait) {
    switch (wait) {
        case SessionWait::nothing:
            break;
        case SessionWait::device:
            return v1::WAIT_REASON_DEVICE;
        case SessionWait::bytes_in_flight:
            return v1::WAIT_REASON_BYTES_IN_FLIGHT;
    }
    return v1::WAIT_REASON_UNSPECIFIED;
}

}  // namespace

v1::Session session_message(const Session& session, const Caller& caller) {
    const SessionState state = session.state();
    v1::Session message;
    message.set_id(session.id());
    message.set_owner(session.owner());
    *message.mutable_description() = session.kind().description;
    message.set_ephemeral(session.kind().ephemeral);
    message.set_published(session.kind().publish);
    message.set_created_at(
        std::chrono::duration_cast<std::chrono::microseconds>(session.created_at().time_since_epoch()).count());
    *message.mutable_settings() = conversion::to_wire(session.settings());
    message.set_uploading(state.uploading);
    message.set_watchers(state.watchers);
    message.set_frames(state.frames);
    if (state.last_frame_index) message.set_last_frame_index(*state.last_frame_index);
    message.set_frames_dropped(state.frames_dropped_replaced + state.frames_dropped_not_nth);
    message.set_frames_skipped(state.frames_skipped);
    if (state.wait != SessionWait::nothing) {
        message.mutable_wait()->set_reason(to_wire(state.wait));
        if (caller.role == Role::admin) message.mutable_wait()->set_session_id(state.waits_for);
    }
    if (state.last_frame) *message.mutable_last_frame() = statistics_message(*state.last_frame);
    return message;
}

}  // namespace meniscus::server
