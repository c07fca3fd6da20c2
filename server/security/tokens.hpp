// A file of tokens, each with the name and the role of a caller.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/limits/name_shares.hpp"

namespace meniscus::server {

enum class Role { uploader, publisher, watcher, admin };
constexpr std::string_view name_of(Role role) {
    switch (role) {
        case Role::uploader:
            return "uploader";
        case Role::publisher:
            return "publisher";
        case Role::watcher:
            return "watcher";
        case Role::admin:
            return "admin";
    }
    return {};
}

/// The caller of a call. By default, where no token is asked for: may do everything, has no name.
struct Caller {
    std::string name;
    Role role = Role::admin;
    OwnShares shares{};     ///< what the tokens file says of this name
    std::string account{};  ///< the name, or without tokens the peer's address; empty: it has no limits of its own
};

/// SHA-256. Tokens are kept and compared as digests, which are all of one length.
using TokenDigest = std::array<unsigned char, 32>;

TokenDigest digest_of(std::string_view token);
/// Takes a time that does not depend on where they differ.
bool equal(const TokenDigest& a, const TokenDigest& b);

class Tokens {
public:
    /// Lines `role name token`, then shares of that name such as `sessions=4`; those that begin with # are comments. A
    /// name's shares hold for all of its tokens. Throws InvalidInput that names file and line, never a token.
    static Tokens load(const std::string& path);

    /// Takes a time that depends on the number of tokens, not on which one it is.
    std::optional<Caller> find(std::string_view token) const;

    std::size_t size() const noexcept { return entries_.size(); }
    bool operator==(const Tokens& other) const;

private:
    struct Entry {
        TokenDigest digest;
        Caller caller;
    };
    std::vector<Entry> entries_;
};

}  // namespace meniscus::server
