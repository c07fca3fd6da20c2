// Decides which caller may do what. Nothing else does.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "security/peer_address.hpp"
#include "security/tokens.hpp"
#include "security/trusted_peers.hpp"

namespace meniscus::server {

/// The calls, by what they do.
enum class Action {
    describe_server,
    list_sessions,
    get_session,
    watch,
    snapshot,
    list_recordings,
    read_recording,
    create_session,
    stream,
    publish,
    delete_session,
    delete_recording
};

/// A watcher describes the server, lists, describes and watches all sessions, lists and reads their recordings. An
/// uploader does everything with sessions of its own but to publish surfaces, and sees no others; a publisher does
/// that, too. An admin does everything. Thread-safe.
class Authorizer {
public:
    /// trusted: peers through which others come.
    explicit Authorizer(TrustedPeers trusted = TrustedPeers()) : trusted_(std::move(trusted)) {}

    /// For calls from now on. Before the first call of it every client may do everything.
    void replace(Tokens tokens);

    /// authorization: the values of the call's header of that name. Throws Refusal: unauthenticated without one token
    /// that is known, permission_denied if its role is not enough.
    Caller admit(std::span<const std::string_view> authorization, const PeerAddress& peer, Action action) const;

    /// Whether calls need a token.
    bool asks_for_tokens() const;

    /// Peers through which others come.
    const TrustedPeers& trusted() const noexcept { return trusted_; }

    /// Whether sessions of this owner exist for this caller.
    static bool may_see(const Caller& caller, std::string_view owner);
    /// Whether that is so for the same owners.
    static bool see_the_same(const Caller& a, const Caller& b);

private:
    const TrustedPeers trusted_;
    mutable std::mutex mutex_;  ///< for the pointer
    std::shared_ptr<const Tokens> tokens_;
};

}  // namespace meniscus::server
