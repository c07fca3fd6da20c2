#include "rpc/handlers/delete_session_handler.hpp"

#include "rpc/calls/caller.hpp"

namespace meniscus::server {

v1::DeleteSessionResponse delete_session(SessionRegistry& registry, const Caller& caller,
                                         const v1::DeleteSessionRequest& request) {
    registry.remove(find_session(caller, registry, request.id()));
    return {};
}

}  // namespace meniscus::server
