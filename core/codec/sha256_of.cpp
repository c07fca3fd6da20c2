#include "codec/sha256.hpp"
#include "meniscus/sha256.hpp"

namespace meniscus {

std::string sha256_of(std::string_view bytes) {
    Sha256 sha;
    sha.add(std::as_bytes(std::span(bytes)));
    return sha.hexadecimal();
}

}  // namespace meniscus
