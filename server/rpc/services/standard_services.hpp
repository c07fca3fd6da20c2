// gRPC's own services, on demand: reflection and channelz.
#pragma once

namespace grpc {
class ServerBuilder;
}

namespace meniscus::server {

struct StandardServices {
    bool reflection = false;  ///< clients may read the contract
    bool channelz = false;    ///< clients may read the server's connections and their traffic
};

/// Call it before a builder is constructed: gRPC adds its services to all builders that follow. Later calls do nothing.
void load_standard_services();
/// Adds the services that are chosen.
void add_standard_services(grpc::ServerBuilder& builder, const StandardServices& services);

}  // namespace meniscus::server
