// Bricks in the packed profile, written on the device where their mesh lies.
#pragma once

#include <cstddef>
#include <cstdint>

#include "codec/attribute_values.hpp"
#include "codec/lattice/packed_fields.hpp"
#include "engine/cuda/kept_lattice.hpp"
#include "engine/cuda/launch.hpp"
#include "lattice/word_hash.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/element_type.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/surface_lattice.hpp"

namespace meniscus::cuda {

/// A mesh on the device and the kept part of its lattice: device pointers.
struct LatticeOnDevice {
    const LatticePosition* vertices = nullptr;
    const Normal* normals = nullptr;
    const LatticeBlock* blocks = nullptr;
    const KeptBlock* kept = nullptr;  ///< beside each of the blocks
    const KeptBrick* bricks = nullptr;
    std::uint32_t offset_bits = 0;
};

struct PackedForm {
    int offset_bits = 0;
    int normal_bits = 0;  ///< 0: no normals
};

/// Where a brick goes. Its bytes are zero before, up to a multiple of 8.
struct PackedPlace {
    std::uint64_t at = 0;     ///< index of its first byte, a multiple of 8
    std::uint32_t brick = 0;  ///< index of its KeptBrick
    std::uint32_t words = 0;  ///< of 8 bytes
};

MENISCUS_HD inline PackedCounts packed_counts(const KeptBrick& brick) {
    const BrickTotals& totals = brick.totals;
    return {.rows = brick.rows,
            .cells = totals.cells,
            .has_one_level = (brick.levels & (brick.levels - 1)) == 0,
            .signs = totals.signs,
            .faces = totals.faces,
            .middles = totals.middles,
            .vertices = totals.vertices};
}

/// An attribute of the vertices on the device, in the form of its code.
struct AttributeOnDevice {
    AttributeOnDevice(const CodedAttribute& form, const std::byte* on_device);

    const std::byte* values;
    std::uint32_t components;
    std::uint32_t exact_bytes;  ///< bytes of a vertex's value
    std::uint32_t coded_bytes;
    int bits;  ///< of a component; 0: its bytes are sent as they are
    CodedRange range[max_attribute_components];
};

/// Writes all of the bricks but their attributes.
void pack_bricks(const LatticeOnDevice& mesh, const PackedForm& form, const PackedPlace* places, std::uint32_t count,
                 std::byte* out, const Launcher& launch);
/// Writes an attribute's values. bytes_before: coded bytes of a vertex's attributes before this one.
void pack_attribute(const LatticeOnDevice& mesh, const PackedForm& form, const AttributeOnDevice& attribute,
                    std::uint32_t bytes_before, const PackedPlace* places, std::uint32_t count, std::byte* out,
                    const Launcher& launch);
/// The hash of each brick's words.
void hash_packed_bricks(const PackedPlace* places, std::uint32_t count, const std::byte* bytes, WordHash* hashes,
                        const Launcher& launch);

}  // namespace meniscus::cuda
