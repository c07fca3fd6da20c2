// gRPC's own services: health, and on demand reflection and channelz.
#pragma once

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

namespace meniscus::server {

struct StandardServices {
    bool reflection = false;  ///< clients may ask for the contract
    bool channelz = false;    ///< clients may ask for connections and their traffic
};

/// Before a builder is made: gRPC makes its services known to all builders that follow, once.
void load_standard_services();
/// Gives the server those that are chosen, and health.
void add_standard_services(grpc::ServerBuilder& builder, const StandardServices& services);

/// The health of every service and of the server as a whole.
void set_serving(grpc::Server& server, bool serving);

}  // namespace meniscus::server
