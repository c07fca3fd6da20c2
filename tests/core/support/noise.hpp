// White noise over random levels, in place of the particles of a frame: the same for the CPU and for a device.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/cell_bend.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::test {

struct NoiseWorld {
    std::uint64_t seed = 0;
    int first = 0;       ///< coordinate of its first base cells; with the side at most 32
    int side = 5;        ///< base cells
    double share = 0.5;  ///< share of the points that are inside
    bool ties = false;   ///< many values lie exactly on the iso-value
    bool uniform = false;
    bool bisects = false;
    bool keeps_slivers = true;  ///< see Slivers
    int max_level = 3;          ///< cap of the levels from which the mesh is emitted
    double band_share = 1.0;    ///< share of base cells that start in the band; others must join by the samples
};

/// The iso-value is 1.
Settings noise_settings(const NoiseWorld& world);

/// The findings of the first steps about every base cell of the world, in the order of their numbers.
struct NoiseLevels {
    std::vector<std::uint8_t> wanted;
    std::vector<bool> starts;     ///< whether a cell starts in the band, even if its corners agree
    std::vector<CellBend> bends;  ///< traces alone: some none, some far too large
};
NoiseLevels noise_levels(const NoiseWorld& world);

/// White noise at lattice points strictly inside a box of base cells, zero at its border and beyond. A point in units
/// from a base cell's corner.
MENISCUS_HD inline float noise_value(const NoiseWorld& world, const Int3& base_cell, float px, float py, float pz) {
    const std::int64_t p[3] = {base_cell.x * std::int64_t{units_per_base_cell} + static_cast<std::int64_t>(px),
                               base_cell.y * std::int64_t{units_per_base_cell} + static_cast<std::int64_t>(py),
                               base_cell.z * std::int64_t{units_per_base_cell} + static_cast<std::int64_t>(pz)};
    std::uint64_t h = world.seed;
    for (const std::int64_t c : p) {
        const std::int64_t low = std::int64_t{world.first} * units_per_base_cell;
        if (c <= low || c >= low + std::int64_t{world.side} * units_per_base_cell) return 0.0F;
        h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 29;
    }
    const double uniform = static_cast<double>(h >> 11) * 0x1p-53;
    if (world.ties && (h & 7) < 3) return 1.0F;
    return uniform < world.share ? 1.0F + static_cast<float>(uniform) : static_cast<float>(uniform) * 0.9F;
}

/// The bits of a brick's cells that the world holds, as Brick::occupied has them. Returns whether it holds any.
bool mark_world(const NoiseWorld& world, const Int3& brick, std::uint64_t* occupied);

/// The mesh of a world by the pipeline with the CPU's steps.
Mesh mesh_of_noise_on_cpu(const NoiseWorld& world);

/// The number of worlds of a test, of which the suite has `count`: times MENISCUS_NOISE_WORLDS, where that is set.
std::uint64_t noise_worlds(std::uint64_t count);

/// Calls visit(world) for the worlds of a test: `count` seeds from `first` on.
template <class Visit>
void for_each_seed(NoiseWorld world, std::uint64_t first, std::uint64_t count, const Visit& visit) {
    for (world.seed = first; world.seed < first + count; ++world.seed) visit(world);
}

}  // namespace meniscus::test
