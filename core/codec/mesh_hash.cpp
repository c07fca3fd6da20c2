// SHA-256 over the triangles in their canonical order.
#include "meniscus/mesh_hash.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <span>

#include "codec/sha256.hpp"
#include "meniscus/canonical_order.hpp"

namespace meniscus {
namespace {

template <class Number>
void add(Sha256& sha, const Number& value) {
    static_assert(std::endian::native == std::endian::little, "numbers are hashed as they lie in memory");
    sha.add(std::as_bytes(std::span(&value, 1)));
}

}  // namespace

std::string mesh_sha256(const Mesh& mesh) {
    Mesh ordered;  // only the hashed members
    ordered.levels = mesh.levels;
    ordered.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
    ordered.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    put_in_canonical_order(ordered);
    Sha256 sha;
    add(sha, mesh.cell_size);
    add(sha, mesh.offset_bits);
    add(sha, std::uint64_t{ordered.triangles.size()});
    // By the levels' bytes, of which crack filling has the least.
    for (const TriangleLevel level :
         {TriangleLevel::crack, TriangleLevel::level1, TriangleLevel::level2, TriangleLevel::level3}) {
        const TriangleRange range = ordered.levels[static_cast<std::size_t>(level)];
        for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
            const auto& [a, b, c] = ordered.triangles[t];
            add(sha, level_byte(level));
            add(sha, std::array{ordered.vertices[a], ordered.vertices[b], ordered.vertices[c]});
        }
    }
    return sha.hexadecimal();
}

}  // namespace meniscus
