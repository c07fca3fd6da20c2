#include "rpc/get_session_handler.hpp"

#include "rpc/session_message.hpp"

namespace meniscus::server {

v1::GetSessionResponse get_session(SessionRegistry& registry, const Caller& caller,
                                   const v1::GetSessionRequest& request) {
    v1::GetSessionResponse response;
    const auto session = registry.find(request.id());
    Authorizer::require_access(caller, Action::get_session, session->id(), session->owner());
    *response.mutable_session() = session_message(*session);
    return response;
}

}  // namespace meniscus::server
