// SHA-256 brick by brick: a sum over bricks, which those that have some each can reduce in any order.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "codec/sha256.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"

namespace meniscus {
namespace {

using Corners = std::array<LatticePosition, 3>;

/// A brick's content as it is hashed. Keeps its memory from brick to brick.
class HashedBrick {
public:
    std::array<std::byte, Sha256::digest_bytes> digest(const Mesh& mesh, const MeshBrick& brick) {
        bytes_.clear();
        add(mesh.cell_size);
        add(mesh.offset_bits);
        add(brick.coordinate);
        add(std::uint64_t{brick.triangle_count()});
        // By the levels' bytes, of which crack filling has the least.
        for (const TriangleLevel level :
             {TriangleLevel::crack, TriangleLevel::level1, TriangleLevel::level2, TriangleLevel::level3}) {
            sort(mesh, brick.ranges[static_cast<std::size_t>(level)]);
            for (const Corners& corners : sorted_) {
                add(level_byte(level));
                add(corners);
            }
        }
        Sha256 sha;
        sha.add(bytes_);
        return sha.digest();
    }

private:
    void sort(const Mesh& mesh, const TriangleRange& range) {
        sorted_.clear();
        for (const Triangle& t : std::span(mesh.triangles).subspan(range.first, range.count)) {
            Corners corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
            sorted_.push_back(corners);
        }
        std::sort(sorted_.begin(), sorted_.end());
    }

    template <class Value>
    void add(const Value& value) {
        static_assert(std::endian::native == std::endian::little, "numbers are hashed as they lie in memory");
        const auto bytes = std::as_bytes(std::span(&value, 1));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    std::vector<Corners> sorted_;
    std::vector<std::byte> bytes_;
};

/// A number of 256 bits, its highest byte first.
using Sum = std::array<std::byte, Sha256::digest_bytes>;

/// Modulo 2^256.
void add(Sum& sum, const Sum& number) {
    unsigned carry = 0;
    for (std::size_t i = sum.size(); i-- > 0;) {
        carry += std::to_integer<unsigned>(sum[i]) + std::to_integer<unsigned>(number[i]);
        sum[i] = static_cast<std::byte>(carry & 0xFFU);
        carry >>= 8U;
    }
}

}  // namespace

std::string bricks_sha256(const Mesh& mesh) {
    if (mesh.bricks.empty() && !mesh.triangles.empty())
        throw InvalidInput("the mesh has " + std::to_string(mesh.triangles.size()) +
                           " triangles and no bricks: bricks_sha256 is of a mesh as it is reconstructed or received, "
                           "before it is put in another order");
    Sum sum{};
    HashedBrick hashed;
    for (const MeshBrick& brick : mesh.bricks) add(sum, hashed.digest(mesh, brick));
    return hexadecimal(sum);
}

}  // namespace meniscus
