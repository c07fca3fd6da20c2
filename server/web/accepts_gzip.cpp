#include "web/accepts_gzip.hpp"

namespace meniscus::server {

namespace {

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// "q=0", "q=0.0" and the like: this one not.
bool refuses(std::string_view weight) {
    return weight.starts_with("q=") && weight.find_first_not_of("0.", 2) == std::string_view::npos;
}

}  // namespace

bool accepts_gzip(std::string_view accept_encoding) {
    while (!accept_encoding.empty()) {
        const std::size_t comma = accept_encoding.find(',');
        const std::string_view item = accept_encoding.substr(0, comma);
        const std::size_t semicolon = item.find(';');
        const std::string_view weight =
            semicolon == std::string_view::npos ? std::string_view() : trimmed(item.substr(semicolon + 1));
        if (trimmed(item.substr(0, semicolon)) == "gzip") return !refuses(weight);
        accept_encoding.remove_prefix(comma == std::string_view::npos ? accept_encoding.size() : comma + 1);
    }
    return false;
}

}  // namespace meniscus::server
