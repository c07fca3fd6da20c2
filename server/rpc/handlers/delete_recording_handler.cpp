#include "rpc/handlers/delete_recording_handler.hpp"

#include <exception>

#include "meniscus/v1/recording_service.pb.h"
#include "rpc/messages/session_id.hpp"

namespace meniscus::server {

void delete_recording(RecordingReads& reads, UnaryCall& call) {
    const auto request = call.request<v1::DeleteRecordingRequest>();
    require_same_session(metadata_session_id(call.context()), request.session_id());
    reads.require_going_on();
    reads.post([&call, request](RecordingCatalog& catalog) {
        if (call.finish_if_canceled()) return;
        try {
            const Caller& caller = call.caller();
            const auto may_see = [&](const std::string& owner) { return Authorizer::may_see(caller, owner); };
            catalog.remove(
                {.session_id = request.session_id(), .number = request.number()}, may_see,
                (caller.name.empty() ? "asked for by " : "asked for by " + caller.name + " at ") + call.peer());
            call.answer(v1::DeleteRecordingResponse());
        } catch (...) {
            call.refuse(std::current_exception());
        }
    });
}

}  // namespace meniscus::server
