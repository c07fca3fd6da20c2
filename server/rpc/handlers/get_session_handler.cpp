#include "rpc/handlers/get_session_handler.hpp"

#include "rpc/calls/caller.hpp"
#include "rpc/messages/session_message.hpp"

namespace meniscus::server {

v1::GetSessionResponse get_session(SessionRegistry& registry, const Caller& caller,
                                   const v1::GetSessionRequest& request) {
    v1::GetSessionResponse response;
    *response.mutable_session() = session_message(*find_session(caller, registry, request.id()), caller);
    return response;
}

}  // namespace meniscus::server
