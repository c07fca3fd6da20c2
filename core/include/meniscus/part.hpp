// A frame in parts: each is reconstructed by itself, and together they give the surface of the whole to the bit.
// (core/README.md#parts-that-are-put-together)
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/brick_box.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

inline constexpr std::uint32_t default_overlap = 4;
/// From here on a part settles all of space.
inline constexpr std::uint32_t max_overlap = 2U * brick_end * brick_base_cells;

/// The extremes of one component of a float32 array over all particles of a frame, which the means of a frame's
/// attributes lie between.
struct ArrayRange {
    std::string name;  ///< the array's
    std::uint32_t component = 0;
    float least = 0.0F, greatest = 0.0F;
    bool operator==(const ArrayRange&) const = default;
};
/// The ranges over these particles of the arrays that the settings make attributes. Throws InvalidInput as validate()
/// does for a frame's arrays.
std::vector<ArrayRange> array_ranges(const ParticleFrame& frame, const Settings& settings);
/// Takes the ranges of other particles into `ranges`.
void widen(std::vector<ArrayRange>& ranges, const std::vector<ArrayRange>& others);

/// A part of a frame.
struct FramePart {
    BrickBox own = all_bricks;                ///< the bricks whose surface the part makes
    std::uint32_t overlap = default_overlap;  ///< base cells around those that settle with them, 1 to max_overlap
    std::vector<ArrayRange>
        ranges{};  ///< of the whole frame; of arrays that are not named those of the particles given
};

/// The box of space, world units, around a part: its particles are all of the frame's that lie within it, or more.
Box reach_of(const FramePart& part, const Settings& settings, unsigned coarsest_level);

/// Two bricks that touch, of which one is a part's own and the other is not.
struct Seam {
    BrickCoordinate first{};   ///< the one that comes first in (z, y, x)
    BrickCoordinate second{};  ///< the other
    /// Of the state on both sides as the part has found it. Where the other brick's part has found another, or has no
    /// such seam, both are to be made again with more overlap.
    ContentHash hash{};
    bool operator==(const Seam&) const = default;
};

/// What a part's reconstruction tells beside its mesh.
struct PartOutcome {
    std::vector<Seam> seams;           ///< by first, then by second; those with nothing on either side are left out
    std::uint64_t sixfold_volume = 0;  ///< six times the volume over (c/2^offset_bits)^3, modulo 2^64: a sum over the
                                       ///< part's triangles, so that all parts' add up to the whole's
    float greatest_sample = 0.0F;      ///< greatest value of the field that was sampled, where the mesh is empty
};

}  // namespace meniscus
