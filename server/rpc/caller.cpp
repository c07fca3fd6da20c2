#include "rpc/caller.hpp"

#include <string_view>
#include <vector>

#include "web/web_peer.hpp"

namespace meniscus::server {

Caller admit(const Authorizer& authorizer, const grpc::ServerContextBase& context, Action action) {
    std::vector<std::string_view> values;
    const auto [first, last] = context.client_metadata().equal_range("authorization");
    for (auto entry = first; entry != last; ++entry) values.emplace_back(entry->second.data(), entry->second.size());
    return authorizer.admit(values, PeerAddress::of_grpc(peer_of(context)), action);
}

std::shared_ptr<NameAccount> account_of(const Caller& caller, SessionRegistry& registry) {
    if (caller.account.empty()) return nullptr;
    return registry.account(caller.account, caller.shares);
}

std::shared_ptr<Session> find_session(const Caller& caller, SessionRegistry& registry, const std::string& id) {
    return registry.find(id, [&](const std::string& owner) { return Authorizer::may_see(caller, owner); });
}

std::string peer_of(const grpc::ServerContextBase& context) {
    std::string peer = context.peer();
    // gRPC knows no peer of calls from within the process. Nobody else makes them: elsewhere the metadata are a claim
    // of the client's.
    if (peer != "unknown" && !peer.starts_with("inproc")) return peer;
    const auto web = context.client_metadata().find(web_peer_key);
    if (web == context.client_metadata().end()) return peer;
    return std::string(web->second.data(), web->second.size()) + " (web)";
}

}  // namespace meniscus::server
