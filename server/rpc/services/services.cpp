#include "rpc/services/services.hpp"

#include <memory>
#include <utility>

#include "meniscus/v1/recording_service.grpc.pb.h"
#include "meniscus/v1/server_service.grpc.pb.h"
#include "meniscus/v1/session_service.grpc.pb.h"
#include "meniscus/v1/surface_service.grpc.pb.h"
#include "rpc/calls/unary_call.hpp"
#include "rpc/handlers/create_session_handler.hpp"
#include "rpc/handlers/delete_recording_handler.hpp"
#include "rpc/handlers/delete_session_handler.hpp"
#include "rpc/handlers/get_session_handler.hpp"
#include "rpc/handlers/list_sessions_handler.hpp"
#include "rpc/handlers/read_recording_handler.hpp"
#include "rpc/handlers/recording_lists.hpp"
#include "rpc/handlers/server_info_handler.hpp"
#include "rpc/handlers/stream_handler.hpp"
#include "rpc/handlers/watch_handler.hpp"
#include "rpc/messages/session_id.hpp"

namespace meniscus::server {

namespace {

ByteService::Begin unary(const Authorizer& authorizer, Refusals& refusals, Action action, UnaryCall::Handle handle) {
    return [&authorizer, &refusals, action, handle = std::move(handle)](grpc::CallbackServerContext& context) {
        return UnaryCall::start(authorizer, refusals, action, handle, context);
    };
}

/// answer: to a Request of a Caller.
template <class Request, class Answer>
UnaryCall::Handle about_session(Answer answer) {
    return [answer = std::move(answer)](UnaryCall& call) {
        const auto request = call.request<Request>();
        require_same_session(metadata_session_id(call.context()), request.id());
        call.answer(answer(call.caller(), request));
    };
}

}  // namespace

ServerServiceImpl::ServerServiceImpl(const Authorizer& authorizer, Refusals& refusals,
                                     const BackendDescription& backend, unsigned threads, const Limits& limits,
                                     bool publishes)
    : ByteService(v1::ServerService::service_full_name()) {
    add("GetServerInfo", unary(authorizer, refusals, Action::describe_server, [=](UnaryCall& call) {
            call.request<v1::GetServerInfoRequest>();
            call.answer(get_server_info(backend, threads, limits, publishes));
        }));
}

SessionServiceImpl::SessionServiceImpl(SessionRegistry& registry, Publications* publications,
                                       const Authorizer& authorizer, Refusals& refusals)
    : ByteService(v1::SessionService::service_full_name()) {
    const auto add_unary = [&](const char* method, Action action, UnaryCall::Handle handle) {
        add(method, unary(authorizer, refusals, action, std::move(handle)));
    };
    add_unary("CreateSession", Action::create_session,
              about_session<v1::CreateSessionRequest>([&registry](const Caller& caller, const auto& request) {
                  return create_session(registry, caller, request);
              }));
    add_unary("GetSession", Action::get_session,
              about_session<v1::GetSessionRequest>([&registry](const Caller& caller, const auto& request) {
                  return get_session(registry, caller, request);
              }));
    add_unary("ListSessions", Action::list_sessions, [&registry](UnaryCall& call) {
        call.answer(list_sessions(registry, call.caller(), call.request<v1::ListSessionsRequest>()));
    });
    add_unary(
        "DeleteSession", Action::delete_session,
        about_session<v1::DeleteSessionRequest>([&registry, publications](const Caller& caller, const auto& request) {
            return delete_session(registry, publications, caller, request);
        }));
}

SurfaceServiceImpl::SurfaceServiceImpl(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                                       ActiveCalls& streams, ActiveCalls& watchers)
    : ByteService(v1::SurfaceService::service_full_name()) {
    add("Stream", [&](grpc::CallbackServerContext& context) {
        return start_stream<v1::StreamRequest>(registry, authorizer, refusals, streams, context);
    });
    add("Publish", [&](grpc::CallbackServerContext& context) {
        return start_stream<v1::PublishRequest>(registry, authorizer, refusals, streams, context);
    });
    add("Watch", [&](grpc::CallbackServerContext& context) {
        return start_watch<v1::WatchRequest>(registry, authorizer, refusals, watchers, context);
    });
    add("Snapshot", [&](grpc::CallbackServerContext& context) {
        return start_watch<v1::SnapshotRequest>(registry, authorizer, refusals, watchers, context);
    });
    add("WatchParticles", [&](grpc::CallbackServerContext& context) {
        return start_watch<v1::WatchParticlesRequest>(registry, authorizer, refusals, watchers, context);
    });
}

RecordingServiceImpl::RecordingServiceImpl(RecordingReads* reads, const Authorizer& authorizer, Refusals& refusals,
                                           Metrics& metrics, ActiveCalls& calls)
    : ByteService(v1::RecordingService::service_full_name()) {
    const auto lists = std::make_shared<RecordingLists>();
    add("ListRecordings", unary(authorizer, refusals, Action::list_recordings, [reads, lists](UnaryCall& call) {
            call.request<v1::ListRecordingsRequest>();
            lists->answer(require_recorded(reads), call);
        }));
    add("DeleteRecording", unary(authorizer, refusals, Action::delete_recording,
                                 [reads](UnaryCall& call) { delete_recording(require_recorded(reads), call); }));
    add("ReadRecording", [reads, &authorizer, &refusals, &metrics, &calls](grpc::CallbackServerContext& context) {
        return start_reading(reads, authorizer, refusals, metrics, calls, context);
    });
}

}  // namespace meniscus::server
