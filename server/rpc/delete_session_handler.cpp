#include "rpc/delete_session_handler.hpp"

namespace meniscus::server {

v1::DeleteSessionResponse delete_session(SessionRegistry& registry, const Caller& caller,
                                         const v1::DeleteSessionRequest& request) {
    Authorizer::require_access(caller, Action::delete_session, request.id(), registry.find(request.id())->owner());
    registry.remove(request.id());
    return {};
}

}  // namespace meniscus::server
