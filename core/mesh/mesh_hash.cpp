// SHA-256 over sorted, rotated triangles.
#include "meniscus/mesh_hash.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <stdexcept>
#include <vector>

namespace meniscus {
namespace {

/// SHA-256 of little-endian numbers.
class Sha256 {
public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
            throw std::runtime_error("OpenSSL offers no SHA-256");
    }
    template <class Number>
    void add(Number value) {
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

struct HashedTriangle {
    std::uint8_t level;
    std::array<LatticePosition, 3> corners;
    bool operator<(const HashedTriangle& o) const { return level != o.level ? level < o.level : corners < o.corners; }
};

}  // namespace

std::string mesh_sha256(const Mesh& mesh) {
    std::vector<HashedTriangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        HashedTriangle h{level_byte(mesh.level_of(t)), {}};
        for (std::size_t i = 0; i < 3; ++i) h.corners[i] = mesh.vertices[mesh.triangles[t][i]];
        std::rotate(h.corners.begin(), std::min_element(h.corners.begin(), h.corners.end()), h.corners.end());
        triangles.push_back(h);
    }
    std::sort(triangles.begin(), triangles.end());
    Sha256 sha;
    sha.add(mesh.cell_size);
    sha.add(mesh.offset_bits);
    sha.add(std::uint64_t{mesh.triangles.size()});
    for (const HashedTriangle& t : triangles) {
        sha.add(t.level);
        for (const LatticePosition& corner : t.corners)
            for (const std::int32_t coordinate : corner) sha.add(coordinate);
    }
    return sha.hexadecimal();
}

}  // namespace meniscus
