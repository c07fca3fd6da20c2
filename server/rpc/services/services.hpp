// The gRPC services: they find the handler of a call, and no more.
#pragma once

#include "meniscus/reconstructor.hpp"
#include "publishing/publications.hpp"
#include "recording/recording_reads.hpp"
#include "rpc/calls/active_calls.hpp"
#include "rpc/calls/byte_service.hpp"
#include "rpc/calls/refusals.hpp"
#include "security/authorizer.hpp"
#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

class ServerServiceImpl final : public ByteService {
public:
    ServerServiceImpl(const Authorizer& authorizer, Refusals& refusals, const BackendDescription& backend,
                      unsigned threads, const Limits& limits, bool publishes);
};

class SessionServiceImpl final : public ByteService {
public:
    /// publications: null where nothing is published.
    SessionServiceImpl(SessionRegistry& registry, Publications* publications, const Authorizer& authorizer,
                       Refusals& refusals);
};

class SurfaceServiceImpl final : public ByteService {
public:
    SurfaceServiceImpl(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                       ActiveCalls& streams, ActiveCalls& watchers);
};

class RecordingServiceImpl final : public ByteService {
public:
    /// reads: null where nothing is recorded.
    RecordingServiceImpl(RecordingReads* reads, const Authorizer& authorizer, Refusals& refusals, Metrics& metrics,
                         ActiveCalls& calls);
};

}  // namespace meniscus::server
