// Who may call: a file of tokens, each with a name and a role.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus::server {

enum class Role { uploader, watcher, admin };
constexpr std::string_view name_of(Role role) {
    switch (role) {
        case Role::uploader:
            return "uploader";
        case Role::watcher:
            return "watcher";
        case Role::admin:
            return "admin";
    }
    return {};
}

/// Who makes a call. By default one who was not asked: may do everything, has no name.
struct Caller {
    std::string name;
    Role role = Role::admin;
};

/// SHA-256. Tokens are kept and compared as digests, which are all of one length.
using TokenDigest = std::array<unsigned char, 32>;

TokenDigest digest_of(std::string_view token);
/// In a time that does not depend on where they differ.
bool equal(const TokenDigest& a, const TokenDigest& b);

class Tokens {
public:
    /// Lines `role name token`; those that begin with # are comments. Throws InvalidInput that names file and line,
    /// never a token.
    static Tokens load(const std::string& path);

    /// In a time that does not depend on the token, but on how many there are.
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
