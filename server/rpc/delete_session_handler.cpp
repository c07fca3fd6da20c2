#include "rpc/delete_session_handler.hpp"

namespace meniscus::server {

v1::DeleteSessionResponse delete_session(SessionRegistry& registry, const Caller& caller,
                                         const v1::DeleteSessionRequest& request) {
    const auto session = registry.find(request.id());
    Authorizer::require_access(caller, Action::delete_session, request.id(), session->owner());
    registry.remove(session);
    return {};
}

}  // namespace meniscus::server
