// The gRPC services: they find the handler of a call, and no more.
#pragma once

#include "meniscus/reconstructor.hpp"
#include "meniscus/v1/recording_service.grpc.pb.h"
#include "meniscus/v1/server_service.grpc.pb.h"
#include "meniscus/v1/session_service.grpc.pb.h"
#include "meniscus/v1/surface_service.grpc.pb.h"
#include "recording/recording_reads.hpp"
#include "rpc/active_calls.hpp"
#include "rpc/refusals.hpp"
#include "security/authorizer.hpp"
#include "sessions/session_registry.hpp"

namespace meniscus::server {

/// Raw, so that bytes that are no request are refused in words, and after the token.
using RawServerService = v1::ServerService::WithRawCallbackMethod_GetServerInfo<v1::ServerService::Service>;

class ServerServiceImpl final : public RawServerService {
public:
    ServerServiceImpl(const Authorizer& authorizer, Refusals& refusals, BackendDescription backend, unsigned threads,
                      const Limits& limits);

    grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;

private:
    const Authorizer& authorizer_;
    Refusals& refusals_;
    const BackendDescription backend_;
    const unsigned threads_;
    const Limits limits_;
};

using RawSessionService = v1::SessionService::WithRawCallbackMethod_CreateSession<
    v1::SessionService::WithRawCallbackMethod_GetSession<v1::SessionService::WithRawCallbackMethod_ListSessions<
        v1::SessionService::WithRawCallbackMethod_DeleteSession<v1::SessionService::Service>>>>;

class SessionServiceImpl final : public RawSessionService {
public:
    SessionServiceImpl(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals)
        : registry_(registry), authorizer_(authorizer), refusals_(refusals) {}

    grpc::ServerUnaryReactor* CreateSession(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;
    grpc::ServerUnaryReactor* GetSession(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                         grpc::ByteBuffer* response) override;
    grpc::ServerUnaryReactor* ListSessions(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                           grpc::ByteBuffer* response) override;
    grpc::ServerUnaryReactor* DeleteSession(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;

private:
    SessionRegistry& registry_;
    const Authorizer& authorizer_;
    Refusals& refusals_;
};

/// Raw, so that all receivers share one encoded message.
using RawSurfaceService =
    v1::SurfaceService::WithRawCallbackMethod_Stream<v1::SurfaceService::WithRawCallbackMethod_Watch<
        v1::SurfaceService::WithRawCallbackMethod_WatchParticles<v1::SurfaceService::Service>>>;

class SurfaceServiceImpl final : public RawSurfaceService {
public:
    SurfaceServiceImpl(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                       ActiveCalls& streams, ActiveCalls& watchers)
        : registry_(registry), authorizer_(authorizer), refusals_(refusals), streams_(streams), watchers_(watchers) {}

    grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Stream(grpc::CallbackServerContext* context) override;
    grpc::ServerWriteReactor<grpc::ByteBuffer>* Watch(grpc::CallbackServerContext* context,
                                                      const grpc::ByteBuffer* request) override;
    grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchParticles(grpc::CallbackServerContext* context,
                                                               const grpc::ByteBuffer* request) override;

private:
    SessionRegistry& registry_;
    const Authorizer& authorizer_;
    Refusals& refusals_;
    ActiveCalls& streams_;
    ActiveCalls& watchers_;
};

/// Raw, so that what was recorded is sent as it is.
using RawRecordingService = v1::RecordingService::WithRawCallbackMethod_ListRecordings<
    v1::RecordingService::WithRawCallbackMethod_ReadRecording<v1::RecordingService::Service>>;

class RecordingServiceImpl final : public RawRecordingService {
public:
    /// reads: null where nothing is recorded.
    RecordingServiceImpl(RecordingReads* reads, const Authorizer& authorizer, Metrics& metrics, ActiveCalls& calls)
        : reads_(reads), authorizer_(authorizer), metrics_(metrics), calls_(calls) {}

    grpc::ServerUnaryReactor* ListRecordings(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                             grpc::ByteBuffer* response) override;
    grpc::ServerWriteReactor<grpc::ByteBuffer>* ReadRecording(grpc::CallbackServerContext* context,
                                                              const grpc::ByteBuffer* request) override;

private:
    RecordingReads* const reads_;
    const Authorizer& authorizer_;
    Metrics& metrics_;
    ActiveCalls& calls_;
};

}  // namespace meniscus::server
