#include "security/tokens.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <sstream>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "security/small_file.hpp"

namespace meniscus::server {

namespace {

/// The fewest characters of a token: 128 bits as hexadecimal digits have twice as many.
constexpr std::size_t shortest_token = 16;

constexpr const char* line_format =
    "a line must be: ROLE NAME TOKEN, then any of sessions=N watchers=N frames-per-second=N bytes-in-flight=BYTES";

/// The number of a text such as "12", and with a unit "4M"; none for anything else.
std::optional<std::uint64_t> number_of(std::string_view text, bool with_unit) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    if (unit.empty()) return number;
    constexpr std::string_view units = "KMGT";
    const std::size_t power = units.find(unit);
    if (!with_unit || unit.size() != 1 || power == std::string_view::npos) return std::nullopt;
    const unsigned shift = 10 * (static_cast<unsigned>(power) + 1);
    if (number > (std::numeric_limits<std::uint64_t>::max() >> shift)) return std::nullopt;
    return number << shift;
}

/// Whether a byte is a control character of ASCII; the bytes of other characters are none.
bool is_control(char byte) {
    const auto code = static_cast<unsigned char>(byte);
    return code < 0x20 || code == 0x7f;
}

/// Returns false if the word is none.
bool add_share(std::string_view word, OwnShares& shares) {
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) return false;
    bool is_added = false;
    OwnShares::rows(shares, [&]<class Number>(std::string_view key, std::optional<Number>& share, const Facts& facts) {
        if (key != word.substr(0, equals)) return;
        const auto number = number_of(word.substr(equals + 1), facts.unit == "bytes");
        if (!number || !std::in_range<Number>(*number)) return;
        share = static_cast<Number>(*number);
        is_added = true;
    });
    return is_added;
}

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
        words >> role_name;
        if (role_name.empty() || role_name.starts_with('#')) continue;
        if (!(words >> name >> token)) throw InvalidInput(fmt::format("{}:{}: {}", path, number, line_format));
        // It would stand in the log, and in /metrics.
        if (const auto control = std::ranges::find_if(name, is_control); control != name.end())
            throw InvalidInput(fmt::format("{}:{}: the name has a control character, 0x{:02x}, behind {} others", path,
                                           number, static_cast<unsigned char>(*control), control - name.begin()));
        OwnShares shares;
        std::set<std::string> given;
        for (std::string word; words >> word;) {
            if (!add_share(word, shares)) throw InvalidInput(fmt::format("{}:{}: {}", path, number, line_format));
            const std::string key = word.substr(0, word.find('='));
            if (!given.insert(key).second)
                throw InvalidInput(fmt::format("{}:{}: {} is given twice", path, number, key));
        }
        // The message does not quote the word: it may be a token.
        const auto role = find_by_name<Role>(role_name);
        if (!role)
            throw InvalidInput(fmt::format("{}:{}: a line must be: ROLE NAME TOKEN; its role must be {}", path, number,
                                           listed(names<Role>)));
        if (token.size() < shortest_token)
            throw InvalidInput(
                fmt::format("{}:{}: the token has {} characters; it needs at least {} (make one with "
                            "openssl rand -hex 32)",
                            path, number, token.size(), shortest_token));
        if (tokens.find(token)) throw InvalidInput(fmt::format("{}:{}: the token is there twice", path, number));
        const bool has_shares = shares != OwnShares{};
        for (Entry& entry : tokens.entries_) {
            if (entry.caller.name != name) continue;
            if (!has_shares)
                shares = entry.caller.shares;
            else if (entry.caller.shares == OwnShares{})
                entry.caller.shares = shares;
            else if (entry.caller.shares != shares)
                throw InvalidInput(
                    fmt::format("{}:{}: the shares of {} differ from those on a line above", path, number, name));
        }
        const std::string account = name;
        tokens.entries_.push_back(
            {digest_of(token), {.name = std::move(name), .role = *role, .shares = shares, .account = account}});
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
                                 a.caller.role == b.caller.role && a.caller.shares == b.caller.shares;
                      });
}

}  // namespace meniscus::server
