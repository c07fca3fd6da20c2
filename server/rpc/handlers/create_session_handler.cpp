#include "rpc/handlers/create_session_handler.hpp"

#include <utility>

#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "rpc/calls/caller.hpp"
#include "rpc/messages/session_description.hpp"
#include "rpc/messages/session_message.hpp"

namespace meniscus::server {

v1::CreateSessionResponse create_session(SessionRegistry& registry, const Caller& caller,
                                         const v1::CreateSessionRequest& request) {
    if (!request.has_settings()) throw InvalidInput("CreateSession needs settings");
    const Settings settings = conversion::from_wire(request.settings());
    validate(settings);
    v1::SessionDescription description = checked_description(request.description());
    v1::CreateSessionResponse response;
    const auto [session, is_new] =
        registry.create(request.id(), settings,
                        {.name = caller.name,
                         .account = account_of(caller, registry),
                         .may_see = [&](const std::string& owner) { return Authorizer::may_see(caller, owner); }},
                        {.description = std::move(description),
                         .ephemeral = request.ephemeral(),
                         .stream_follows = request.stream_follows(),
                         .publish = request.publish()});
    response.set_created(is_new);
    *response.mutable_session() = session_message(*session, caller);
    return response;
}

}  // namespace meniscus::server
