#include "rpc/handlers/list_sessions_handler.hpp"

#include "rpc/messages/session_message.hpp"

namespace meniscus::server {

v1::ListSessionsResponse list_sessions(SessionRegistry& registry, const Caller& caller,
                                       const v1::ListSessionsRequest& /*request*/) {
    v1::ListSessionsResponse response;
    for (const auto& session : registry.list())
        if (Authorizer::may_see(caller, session->owner())) *response.add_sessions() = session_message(*session, caller);
    return response;
}

}  // namespace meniscus::server
