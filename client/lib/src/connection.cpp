#include "connection.hpp"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <utility>

#include "meniscus/client/client.hpp"

namespace meniscus::client {

namespace {

std::shared_ptr<grpc::Channel> open_channel(const std::string& address) {
    grpc::ChannelArguments arguments;
    // A server that has just started is found without gRPC's wait of seconds between attempts, and a new connection does
    // not inherit that wait from an old one.
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
    arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 100);
    arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

/// Why there is no connection, in gRPC's words.
std::string connection_failure(v1::ServerService::Stub& server) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(200));
    v1::GetServerInfoResponse response;
    return server.GetServerInfo(&context, {}, &response).error_message();
}

}  // namespace

Connection::Connection(std::string server_address, std::chrono::milliseconds timeout)
    : address(std::move(server_address)),
      channel(open_channel(address)),
      server(v1::ServerService::NewStub(channel)),
      sessions(v1::SessionService::NewStub(channel)),
      surfaces(v1::SurfaceService::NewStub(channel)) {
    if (!channel->WaitForConnected(std::chrono::system_clock::now() + timeout))
        throw ServerError("no server at " + address + " (" + connection_failure(*server) +
                          "): start meniscusd or check the address");
}

void add_session_id(grpc::ClientContext& context, const std::string& session_id) {
    context.AddMetadata("x-session-id", session_id);
}

}  // namespace meniscus::client
