// SHA-256, piece by piece.
#pragma once

#include <openssl/evp.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace meniscus {

class Sha256 {
public:
    Sha256();
    void add(std::span<const std::byte> bytes);
    /// 64 digits in lower case. Nothing is added afterwards.
    std::string hexadecimal();

private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace meniscus
