// SHA-256, piece by piece.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace meniscus {

class Sha256 {
public:
    static constexpr std::size_t digest_bytes = 32;

    /// Throws NotBuilt in a build without OpenSSL.
    Sha256();
    void add(std::span<const std::byte> bytes);
    /// Nothing is added afterwards, here and below.
    std::array<std::byte, digest_bytes> digest();
    /// 64 digits in lower case.
    std::string hexadecimal();

private:
    std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// The digits of bytes, two for each, in lower case.
std::string hexadecimal(std::span<const std::byte> bytes);

}  // namespace meniscus
