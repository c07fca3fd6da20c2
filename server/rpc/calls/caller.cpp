#include "rpc/calls/caller.hpp"

#include <string_view>
#include <utility>
#include <vector>

#include "security/forwarded_client.hpp"
#include "security/web_peer.hpp"

namespace meniscus::server {

namespace {

std::vector<std::string_view> metadata_values(const grpc::ServerContextBase& context, const char* key) {
    std::vector<std::string_view> values;
    const auto [first, last] = context.client_metadata().equal_range(key);
    for (auto entry = first; entry != last; ++entry) values.emplace_back(entry->second.data(), entry->second.size());
    return values;
}

struct Connection {
    std::string peer;  ///< as gRPC writes it
    bool is_web = false;
};

Connection connection_of(const grpc::ServerContextBase& context) {
    std::string peer = context.peer();
    // gRPC knows no peer of calls from within the process. Nobody else makes them: elsewhere the metadata are a claim
    // of the client's.
    if (peer != "unknown" && !peer.starts_with("inproc")) return {.peer = std::move(peer)};
    const auto web = metadata_values(context, web_peer_key);
    if (web.empty()) return {.peer = std::move(peer)};
    return {.peer = std::string(web.front()), .is_web = true};
}

}  // namespace

Caller admit(const Authorizer& authorizer, const grpc::ServerContextBase& context, Action action) {
    return authorizer.admit(metadata_values(context, "authorization"),
                            PeerAddress::of_grpc(connection_of(context).peer), action);
}

std::shared_ptr<NameAccount> account_of(const Caller& caller, SessionRegistry& registry) {
    if (caller.account.empty()) return nullptr;
    return registry.account(caller.account, caller.shares);
}

std::shared_ptr<Session> find_session(const Caller& caller, SessionRegistry& registry, const std::string& id,
                                      SessionRegistry::Look look) {
    return registry.find(
        id, [&](const std::string& owner) { return Authorizer::may_see(caller, owner); }, look);
}

std::string peer_of(const Authorizer& authorizer, const grpc::ServerContextBase& context) {
    const Connection connection = connection_of(context);
    const auto client = forwarded_client(authorizer.trusted(), PeerAddress::of_grpc(connection.peer),
                                         metadata_values(context, forwarded_for_key));
    return (client ? client->text() + " through " : "") + connection.peer + (connection.is_web ? " (web)" : "");
}

}  // namespace meniscus::server
