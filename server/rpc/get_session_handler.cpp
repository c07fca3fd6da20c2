#include "rpc/get_session_handler.hpp"

#include "rpc/session_message.hpp"

namespace meniscus::server {

v1::GetSessionResponse get_session(SessionRegistry& registry, const v1::GetSessionRequest& request) {
    v1::GetSessionResponse response;
    *response.mutable_session() = session_message(*registry.find(request.id()));
    return response;
}

}  // namespace meniscus::server
