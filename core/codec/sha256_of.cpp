#include "codec/sha256.hpp"
#include "meniscus/sha256.hpp"

namespace meniscus {

std::string sha256_of(std::string_view bytes) {
    Sha256 sha;
    sha.add(std::as_bytes(std::span(bytes)));
    return sha.hexadecimal();
}

std::string Sha256::hexadecimal() {
    return meniscus::hexadecimal(digest());
}

std::string hexadecimal(std::span<const std::byte> bytes) {
    std::string text;
    for (const std::byte byte : bytes) {
        text += "0123456789abcdef"[std::to_integer<unsigned>(byte >> 4)];
        text += "0123456789abcdef"[std::to_integer<unsigned>(byte & std::byte{15})];
    }
    return text;
}

}  // namespace meniscus
