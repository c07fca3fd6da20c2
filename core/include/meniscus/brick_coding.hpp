// Bricks of a mesh to bytes and back, without loss of position, connectivity or level.
//
// Every brick is coded by itself, with Codec::draco as a Draco mesh: positions are brick-local uint16 coordinates of
// the refined lattice (0 ... brick_cells * 2^offset_bits; rounded to a coarser lattice if CodingOptions::position_bits
// says so), normals are octahedral. A triangle's level needs no attribute: a crack triangle lies in a face plane of the
// base-cell grid, which no other triangle does; the others lie inside one base cell, and `cell_levels` gives the level
// of every base cell that holds triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/memory.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

struct CodingOptions {
    int normal_bits = 8;    ///< 2 to 16 per octahedral component; 0: no normals. A mesh without normals has none
    int position_bits = 0;  ///< vertices are rounded to multiples of c / 2^position_bits, 2 to the mesh's offset_bits;
                            ///< 0: they are not rounded
    int speed = 10;         ///< Draco's speed, 0 (smallest) to 10 (fastest)
    Codec codec = Codec::draco;
    std::vector<CodedAttribute> attributes{};  ///< as coded_attributes() gives them for this mesh
};

/// The lattice that vertices lie on once they are encoded. Throws InvalidInput for position_bits out of range.
std::uint32_t encoded_offset_bits(const Mesh& mesh, const CodingOptions& options);

using ContentHash = std::array<std::uint64_t, 2>;

/// The part of a mesh that is encoded as one brick: its triangles, over vertices of its own, which are numbered in the
/// order in which the triangles use them.
struct BrickContent {
    std::array<std::int32_t, 3> coordinate{};             ///< x y z in bricks
    std::vector<std::array<std::uint16_t, 3>> positions;  ///< brick-local, in steps of c / 2^encoded_offset_bits
    std::vector<Normal> normals;                          ///< one per vertex; empty if none are sent
    std::vector<Triangle> triangles;
    std::vector<std::byte> cell_levels;  ///< see EncodedBrick
    /// Values of CodingOptions::attributes, in that order: coded_bytes() for each vertex, little-endian.
    std::vector<std::vector<std::byte>> attributes;
    std::vector<CodedAttribute>
        attribute_forms;  ///< part of the content: the same bytes over another range are other values

    /// Equal for equal content; different content has the same hash with a chance of about 2^-128. Not proof against
    /// forgery, and not for files: another version may hash otherwise.
    ContentHash hash() const;
};

struct EncodedBrick {
    std::array<std::int32_t, 3> coordinate{};  ///< x y z in bricks
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
    std::vector<std::byte>
        cell_levels;  ///< two bits per base cell that holds triangles, in (z, y, x) order, low bits first: 1, 2, 3
    std::vector<std::byte> data;  ///< as the codec writes it
    Codec codec = Codec::draco;
};

class LatticeCoder;
class PackedBricks;

/// Memory that bricks are prepared and encoded in, kept from brick to brick: for Draco at most 24 bytes for each
/// triangle of the largest, for the lattice codecs 3 MB and 128 bytes for each vertex of the largest. It serves one
/// brick at a time.
struct BrickScratch {
    /// account: is charged; none: uncounted.
    explicit BrickScratch(std::shared_ptr<MemoryAccount> account = nullptr);
    ~BrickScratch();
    BrickScratch(BrickScratch&&) noexcept;

    Array<std::uint32_t> slots;             ///< slots of a hash table from the mesh's vertices to the brick's
    Array<std::byte> charge;                ///< stands for the coder's memory in the account
    std::unique_ptr<LatticeCoder> lattice;  ///< made for the first brick that needs it
};

/// brick: index into mesh.bricks. Thread-safe. Throws InvalidInput for options out of range, LimitExceeded if the
/// account of the scratch memory would pass its limit.
BrickContent brick_content(const Mesh& mesh, std::size_t brick, const CodingOptions& options, BrickScratch& scratch);
/// The same, with scratch memory of its own.
BrickContent brick_content(const Mesh& mesh, std::size_t brick, const CodingOptions& options = {});
/// A brick whose content is known, but not encoded yet: with the same content as another it need not be.
class PreparedBrick {
public:
    /// The mesh, the options and the scratch memory must stay, and the latter be left alone. Throws as brick_content(),
    /// and InvalidInput for a lattice codec where the mesh has no lattice.
    PreparedBrick(const Mesh& mesh, std::size_t brick, const CodingOptions& options, BrickScratch& scratch);
    /// The same of bricks that a GPU has packed with these options, which must stay, too.
    PreparedBrick(PackedBricks& packed, std::size_t brick, const CodingOptions& options, BrickScratch& scratch);
    /// Equal for equal content. It is not the same for Draco, for the lattice codecs, and for what a GPU has packed.
    ContentHash hash() const;
    /// Brings the brick down from a GPU. Throws DeviceError where that fails.
    EncodedBrick encode() const;

private:
    const CodingOptions& options_;
    /// Drops the coder if the work with it throws.
    template <class Work>
    void guarded(const Work& work) const;

    BrickScratch* scratch_ = nullptr;  ///< its coder has loaded the brick, or loads what comes down; none: `content_`
    PackedBricks* packed_ = nullptr;   ///< those of a GPU; none: the host has the brick
    std::size_t brick_ = 0;
    BrickContent content_;
};

/// Encodes a content with Draco. options: those that the content was made with. Throws InvalidInput for a speed or a
/// codec out of range.
EncodedBrick encode_brick(const BrickContent& content, const CodingOptions& options);
/// The content of a brick, encoded. Throws as PreparedBrick.
EncodedBrick encode_brick(const Mesh& mesh, std::size_t brick, const CodingOptions& options = {});

/// Gives the mesh the normals that it would have if it were encoded with CodingOptions::normal_bits and decoded:
/// rounded, or with 0 none. Throws InvalidInput for bits out of range.
void round_normals(Mesh& mesh, int normal_bits);

/// A brick's own mesh: its vertices are welded by position.
struct DecodedBrick {
    std::array<std::int32_t, 3> coordinate{};
    std::vector<LatticePosition> vertices;  ///< absolute, refined lattice
    std::vector<Normal> normals;            ///< empty if none were sent
    std::vector<Triangle> triangles;
    std::vector<TriangleLevel> levels;      ///< one per triangle
    std::vector<MeshAttribute> attributes;  ///< as they were announced
};

/// attributes: those that the brick's mesh announced. Throws InvalidInput for bytes that are not a brick of this
/// lattice, and for a codec that this version does not know, with its number; never crashes on any bytes.
DecodedBrick decode_brick(const EncodedBrick& brick, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes = {});

/// Encodes a decoded brick again, with Draco. options: its attributes are those that the brick was decoded with.
EncodedBrick encode_brick(const DecodedBrick& brick, std::uint32_t offset_bits, const CodingOptions& options);

/// Welds bricks into one mesh, ordered as reconstruct() orders it (triangles within a brick and level excepted).
/// Throws InvalidInput if a brick occurs twice.
Mesh weld_bricks(std::span<const DecodedBrick> bricks, double cell_size, std::uint32_t offset_bits);

}  // namespace meniscus
