#include "rpc/services.hpp"

#include <exception>
#include <utility>

#include "rpc/caller.hpp"
#include "rpc/create_session_handler.hpp"
#include "rpc/delete_session_handler.hpp"
#include "rpc/get_session_handler.hpp"
#include "rpc/list_recordings_handler.hpp"
#include "rpc/list_sessions_handler.hpp"
#include "rpc/read_recording_handler.hpp"
#include "rpc/server_info_handler.hpp"
#include "rpc/session_id.hpp"
#include "rpc/status.hpp"
#include "rpc/stream_handler.hpp"
#include "rpc/watch_handler.hpp"
#include "rpc/wire_bytes.hpp"

namespace meniscus::server {

namespace {

/// Finishes a unary call that may be made with what `handle`, given the caller and the request, returns or throws. The
/// request is read here, as bytes that are none would else be refused by gRPC, without a word.
template <class Request, class Handle>
grpc::ServerUnaryReactor* answer(const Authorizer& authorizer, Refusals& refusals, grpc::CallbackServerContext& context,
                                 Action action, const grpc::ByteBuffer& bytes, grpc::ByteBuffer& response,
                                 const Handle& handle) {
    grpc::ServerUnaryReactor* reactor = context.DefaultReactor();
    Caller caller;
    try {
        caller = admit(authorizer, context, action);
        response = serialized(handle(caller, parsed<Request>(bytes)));
        reactor->Finish(grpc::Status::OK);
    } catch (...) {
        refusals.report(std::current_exception(), caller.name, peer_of(context));
        reactor->Finish(to_status(std::current_exception()));
    }
    return reactor;
}

/// The same for a call about one session.
template <class Request, class Response>
grpc::ServerUnaryReactor* answer_about_session(const Authorizer& authorizer, Refusals& refusals,
                                               grpc::CallbackServerContext& context, Action action,
                                               SessionRegistry& registry, const grpc::ByteBuffer& bytes,
                                               grpc::ByteBuffer& response,
                                               Response (&handler)(SessionRegistry&, const Caller&, const Request&)) {
    return answer<Request>(authorizer, refusals, context, action, bytes, response,
                           [&](const Caller& caller, const Request& request) {
                               require_same_session(metadata_session_id(context), request.id());
                               return handler(registry, caller, request);
                           });
}

}  // namespace

ServerServiceImpl::ServerServiceImpl(const Authorizer& authorizer, Refusals& refusals, BackendDescription backend,
                                     unsigned threads, const Limits& limits)
    : authorizer_(authorizer), refusals_(refusals), backend_(std::move(backend)), threads_(threads), limits_(limits) {}

grpc::ServerUnaryReactor* ServerServiceImpl::GetServerInfo(grpc::CallbackServerContext* context,
                                                           const grpc::ByteBuffer* request,
                                                           grpc::ByteBuffer* response) {
    return answer<v1::GetServerInfoRequest>(
        authorizer_, refusals_, *context, Action::describe_server, *request, *response,
        [&](const Caller&, const v1::GetServerInfoRequest&) { return get_server_info(backend_, threads_, limits_); });
}

grpc::ServerUnaryReactor* SessionServiceImpl::CreateSession(grpc::CallbackServerContext* context,
                                                            const grpc::ByteBuffer* request,
                                                            grpc::ByteBuffer* response) {
    return answer_about_session(authorizer_, refusals_, *context, Action::create_session, registry_, *request,
                                *response, create_session);
}

grpc::ServerUnaryReactor* SessionServiceImpl::GetSession(grpc::CallbackServerContext* context,
                                                         const grpc::ByteBuffer* request, grpc::ByteBuffer* response) {
    return answer_about_session(authorizer_, refusals_, *context, Action::get_session, registry_, *request, *response,
                                get_session);
}

grpc::ServerUnaryReactor* SessionServiceImpl::ListSessions(grpc::CallbackServerContext* context,
                                                           const grpc::ByteBuffer* request,
                                                           grpc::ByteBuffer* response) {
    return answer<v1::ListSessionsRequest>(authorizer_, refusals_, *context, Action::list_sessions, *request, *response,
                                           [&](const Caller& caller, const v1::ListSessionsRequest& message) {
                                               return list_sessions(registry_, caller, message);
                                           });
}

grpc::ServerUnaryReactor* SessionServiceImpl::DeleteSession(grpc::CallbackServerContext* context,
                                                            const grpc::ByteBuffer* request,
                                                            grpc::ByteBuffer* response) {
    return answer_about_session(authorizer_, refusals_, *context, Action::delete_session, registry_, *request,
                                *response, delete_session);
}

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* SurfaceServiceImpl::Stream(
    grpc::CallbackServerContext* context) {
    return start_stream(registry_, authorizer_, refusals_, streams_, *context);
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* SurfaceServiceImpl::Watch(grpc::CallbackServerContext* context,
                                                                      const grpc::ByteBuffer* request) {
    return start_watch<v1::WatchRequest>(registry_, authorizer_, refusals_, watchers_, *context, *request);
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* SurfaceServiceImpl::WatchParticles(grpc::CallbackServerContext* context,
                                                                               const grpc::ByteBuffer* request) {
    return start_watch<v1::WatchParticlesRequest>(registry_, authorizer_, refusals_, watchers_, *context, *request);
}

grpc::ServerUnaryReactor* RecordingServiceImpl::ListRecordings(grpc::CallbackServerContext* context,
                                                               const grpc::ByteBuffer* request,
                                                               grpc::ByteBuffer* response) {
    grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
    try {
        const Caller caller = admit(authorizer_, *context, Action::list_recordings);
        parsed<v1::ListRecordingsRequest>(*request);
        require_recorded(reads_).post([reactor, response, caller](RecordingCatalog& catalog) {
            try {
                *response = serialized(list_recordings(catalog, caller));
                reactor->Finish(grpc::Status::OK);
            } catch (...) {
                reactor->Finish(to_status(std::current_exception()));
            }
        });
    } catch (...) {
        reactor->Finish(to_status(std::current_exception()));
    }
    return reactor;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* RecordingServiceImpl::ReadRecording(grpc::CallbackServerContext* context,
                                                                                const grpc::ByteBuffer* request) {
    return start_reading(reads_, authorizer_, metrics_, calls_, *context, *request);
}

}  // namespace meniscus::server
