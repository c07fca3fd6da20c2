// SHA-256 over the triangles in their canonical order.
#include "meniscus/mesh_hash.hpp"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <memory>
#include <stdexcept>

#include "meniscus/canonical_order.hpp"

namespace meniscus {
namespace {

/// SHA-256 of little-endian numbers, and of arrays of them.
class Sha256 {
public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
            throw std::runtime_error("OpenSSL offers no SHA-256");
    }
    template <class Number>
    void add(const Number& value) {
        static_assert(std::endian::native == std::endian::little, "numbers are hashed as they lie in memory");
        EVP_DigestUpdate(context_.get(), &value, sizeof value);
    }
    std::string hexadecimal() {
        std::array<unsigned char, 32> digest{};
        EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
        std::string text;
        for (const unsigned char byte : digest) {
            text += "0123456789abcdef"[byte >> 4];
            text += "0123456789abcdef"[byte & 15];
        }
        return text;
    }

private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string mesh_sha256(const Mesh& mesh) {
    Mesh ordered;  // only the hashed members
    ordered.levels = mesh.levels;
    ordered.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
    ordered.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    put_in_canonical_order(ordered);
    Sha256 sha;
    sha.add(mesh.cell_size);
    sha.add(mesh.offset_bits);
    sha.add(std::uint64_t{ordered.triangles.size()});
    // By the levels' bytes, of which crack filling has the least.
    for (const TriangleLevel level :
         {TriangleLevel::crack, TriangleLevel::level1, TriangleLevel::level2, TriangleLevel::level3}) {
        const TriangleRange range = ordered.levels[static_cast<std::size_t>(level)];
        for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
            const auto& [a, b, c] = ordered.triangles[t];
            sha.add(level_byte(level));
            sha.add(std::array{ordered.vertices[a], ordered.vertices[b], ordered.vertices[c]});
        }
    }
    return sha.hexadecimal();
}

}  // namespace meniscus
