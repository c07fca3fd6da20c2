#include "rpc/handlers/delete_session_handler.hpp"

#include <string>

#include "rpc/calls/caller.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

v1::DeleteSessionResponse delete_session(SessionRegistry& registry, Publications* publications, const Caller& caller,
                                         const v1::DeleteSessionRequest& request) {
    // Before the session: once that has gone, another one of its id may publish.
    const bool unpublished = request.unpublish() && publications != nullptr &&
                             publications->remove(request.id(), [&](const std::string& owner) {
                                 return Authorizer::may_see(caller, owner);
                             });
    try {
        registry.remove(find_session(caller, registry, request.id()));
    } catch (const Refusal& refusal) {
        const bool had_ended = refusal.kind() == Refusal::Kind::not_found;
        if (!unpublished || !had_ended) throw;
    }
    return {};
}

}  // namespace meniscus::server
