#include "security/tokens.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <sstream>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "security/small_file.hpp"

namespace meniscus::server {

namespace {

/// Of a token: 128 bits as hexadecimal digits have twice as many.
constexpr std::size_t shortest_token = 16;

}  // namespace

TokenDigest digest_of(std::string_view token) {
    TokenDigest digest;
    SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), digest.data());
    return digest;
}

bool equal(const TokenDigest& a, const TokenDigest& b) {
    return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

Tokens Tokens::load(const std::string& path) {
    require_private(path);
    std::istringstream lines(read_small_file(path));
    Tokens tokens;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::istringstream words(line);
        std::string role_name;
        std::string name;
        std::string token;
        std::string more;
        words >> role_name;
        if (role_name.empty() || role_name.starts_with('#')) continue;
        if (!(words >> name >> token) || words >> more)
            throw InvalidInput(fmt::format("{}:{}: a line must be: ROLE NAME TOKEN", path, number));
        // What stands there may be a token.
        const auto role = find_by_name<Role>(role_name);
        if (!role) throw InvalidInput(fmt::format("{}:{}: the role must be {}", path, number, listed(names<Role>)));
        if (token.size() < shortest_token)
            throw InvalidInput(
                fmt::format("{}:{}: the token has {} characters; it needs at least {} (make one with "
                            "openssl rand -hex 32)",
                            path, number, token.size(), shortest_token));
        if (tokens.find(token)) throw InvalidInput(fmt::format("{}:{}: the token is there twice", path, number));
        tokens.entries_.push_back({digest_of(token), {std::move(name), *role}});
    }
    if (tokens.entries_.empty()) throw InvalidInput(fmt::format("{} has no tokens: nobody could call", path));
    return tokens;
}

std::optional<Caller> Tokens::find(std::string_view token) const {
    const TokenDigest digest = digest_of(token);
    const Entry* found = nullptr;
    for (const Entry& entry : entries_)
        if (equal(entry.digest, digest)) found = &entry;
    if (found == nullptr) return std::nullopt;
    return found->caller;
}

bool Tokens::operator==(const Tokens& other) const {
    return std::equal(entries_.begin(), entries_.end(), other.entries_.begin(), other.entries_.end(),
                      [](const Entry& a, const Entry& b) {
                          return a.digest == b.digest && a.caller.name == b.caller.name &&
                                 a.caller.role == b.caller.role;
                      });
}

}  // namespace meniscus::server
