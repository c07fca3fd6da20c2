#include "rpc/delete_session_handler.hpp"


namespace meniscus::server {

v1::DeleteSessionResponse delete_session(SessionRegistry& registry, const v1::DeleteSessionRequest& request) {
    registry.remove(request.id());
    return {};
}

}  // namespace meniscus::server
