#include "security/authorizer.hpp"

#include <fmt/format.h>
#include <strings.h>

#include <utility>

#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

std::string_view name_of(Action action) {
    switch (action) {
        case Action::describe_server:
            return "GetServerInfo";
        case Action::list_sessions:
            return "ListSessions";
        case Action::get_session:
            return "GetSession";
        case Action::watch:
            return "Watch";
        case Action::snapshot:
            return "Snapshot";
        case Action::list_recordings:
            return "ListRecordings";
        case Action::read_recording:
            return "ReadRecording";
        case Action::create_session:
            return "CreateSession";
        case Action::stream:
            return "Stream";
        case Action::publish:
            return "Publish";
        case Action::delete_session:
            return "DeleteSession";
        case Action::delete_recording:
            return "DeleteRecording";
    }
    return "this call";
}

bool only_looks(Action action) {
    return action == Action::describe_server || action == Action::list_sessions || action == Action::get_session ||
           action == Action::watch || action == Action::snapshot || action == Action::list_recordings ||
           action == Action::read_recording;
}

/// Whether the role gives rights on the caller's own sessions alone.
bool is_owner(Role role) {
    return role == Role::uploader || role == Role::publisher;
}

void require_role(const Caller& caller, Action action) {
    const auto refuse = [&](const char* needed) {
        throw Refusal(Refusal::Kind::permission_denied,
                      fmt::format("{} needs a token of the role {} or admin; that of {} has the role {}",
                                  name_of(action), needed, caller.name, name_of(caller.role)));
    };
    if (action == Action::publish && caller.role != Role::publisher && caller.role != Role::admin) refuse("publisher");
    if (caller.role == Role::watcher && !only_looks(action)) refuse("uploader");
}

std::string_view bearer_token(std::string_view authorization) {
    constexpr std::string_view scheme = "Bearer ";
    if (authorization.size() < scheme.size() || ::strncasecmp(authorization.data(), scheme.data(), scheme.size()) != 0)
        throw Refusal(Refusal::Kind::unauthenticated, "the metadata authorization must be: Bearer TOKEN");
    return authorization.substr(scheme.size());
}

}  // namespace

void Authorizer::replace(Tokens tokens) {
    auto replacement = std::make_shared<const Tokens>(std::move(tokens));
    const std::lock_guard lock(mutex_);
    tokens_ = std::move(replacement);
}

Caller Authorizer::admit(std::span<const std::string_view> authorization, const PeerAddress& peer,
                         Action action) const {
    std::shared_ptr<const Tokens> tokens;
    {
        const std::lock_guard lock(mutex_);
        tokens = tokens_;
    }
    if (!tokens) {
        if (trusted_.is_exempt(peer)) return {};
        Caller caller;
        caller.account = peer.share().text();
        return caller;
    }
    if (authorization.size() != 1)
        throw Refusal(Refusal::Kind::unauthenticated,
                      fmt::format("this server asks for a token, and the call has {} (metadata authorization: Bearer "
                                  "TOKEN)",
                                  authorization.empty() ? "none" : std::to_string(authorization.size())));
    auto caller = tokens->find(bearer_token(authorization.front()));
    if (!caller) throw Refusal(Refusal::Kind::unauthenticated, "the token is none of this server's");
    require_role(*caller, action);
    return *std::move(caller);
}

bool Authorizer::asks_for_tokens() const {
    const std::lock_guard lock(mutex_);
    return tokens_ != nullptr;
}

bool Authorizer::may_see(const Caller& caller, std::string_view owner) {
    return !is_owner(caller.role) || caller.name == owner;
}

bool Authorizer::see_the_same(const Caller& a, const Caller& b) {
    if (!is_owner(a.role) || !is_owner(b.role)) return !is_owner(a.role) && !is_owner(b.role);
    return a.name == b.name;
}

}  // namespace meniscus::server
