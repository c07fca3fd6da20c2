// A build without OpenSSL.
#include "codec/sha256.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

Sha256::Sha256() : context_(nullptr, nullptr) {
    throw NotBuilt("SHA-256 (mesh_sha256)", "OpenSSL: build it where libssl-dev is installed");
}

void Sha256::add(std::span<const std::byte> /*bytes*/) {}

std::array<std::byte, Sha256::digest_bytes> Sha256::digest() {
    return {};
}

}  // namespace meniscus
