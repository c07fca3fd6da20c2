// The channel to one server, shared by the client and its streams.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/v1/recording_service.grpc.pb.h"
#include "meniscus/v1/server_service.grpc.pb.h"
#include "meniscus/v1/session_service.grpc.pb.h"
#include "meniscus/v1/surface_service.grpc.pb.h"

namespace meniscus::client {

class Connection {
public:
    /// Throws ServerError unless the server is there, InvalidInput if the address or the options are wrong.
    explicit Connection(const std::string& address, const ConnectionOptions& options = {});

    /// Gives a call the token, and the id of the session that it is about; empty: about none.
    void add_metadata(grpc::ClientContext& context, const std::string& session_id) const;
    /// The codecs of this version that the server offers, asked for once; Draco, which all offer, as long as it does
    /// not answer.
    std::vector<Codec> offered_codecs(const std::stop_token& stop = {}) const;

    const std::string address;                ///< with its port
    const std::chrono::milliseconds timeout;  ///< for an answer
    const std::shared_ptr<grpc::Channel> channel;
    const std::unique_ptr<v1::ServerService::Stub> server;
    const std::unique_ptr<v1::SessionService::Stub> sessions;
    const std::unique_ptr<v1::SurfaceService::Stub> surfaces;
    const std::unique_ptr<v1::RecordingService::Stub> recordings;

private:
    const std::string token_;
    mutable std::mutex mutex_;  ///< for what follows
    mutable std::optional<std::vector<Codec>> offered_codecs_;
};

/// Every call about one session carries its id as metadata too. Throws InvalidInput for what cannot be there.
void add_session_id(grpc::ClientContext& context, const std::string& session_id);

}  // namespace meniscus::client
