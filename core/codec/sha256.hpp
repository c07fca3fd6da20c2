// SHA-256, piece by piece.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace meniscus {

class Sha256 {
public:
    /// Throws NotBuilt in a build without OpenSSL.
    Sha256();
    void add(std::span<const std::byte> bytes);
    /// 64 digits in lower case. Nothing is added afterwards.
    std::string hexadecimal();

private:
    std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

}  // namespace meniscus
