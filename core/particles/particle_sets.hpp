// Step 1 on the CPU: a frame's particles, one sorted set per particle level, and the base cells that they reach.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/arrays.hpp"
#include "engine/cpu/scan.hpp"
#include "engine/cpu/workers.hpp"
#include "field/lattice_settings.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/particle_set.hpp"
#include "steps/register_particles/register_particles.hpp"

namespace meniscus::cpu {

/// The particles of one level.
struct ParticleSet {
    explicit ParticleSet(const std::shared_ptr<MemoryAccount>& account);

    BrickGrid cells;
    Array<ParticleKey> keys;
    Array<std::uint32_t> first;
    Array<std::uint64_t> cell_keys;
    // Of every particle, and room for whole lanes beyond the last; ParticleSetView explains them.
    Array<float> x, y, z, weight;
    Array<float> densities;  ///< relative to the rest density; color field only
    std::size_t count() const { return keys.size(); }
    std::int64_t cell_units = 0;
    float support = 0.0F;

    ParticleSetView view() const {
        return {cells.view(), first.data(), x.data(), y.data(), z.data(), weight.data(), cell_units, support};
    }
};

class ParticleSets {
public:
    ParticleSets(const std::shared_ptr<MemoryAccount>& account, Workers& workers, const LatticeSettings& settings);

    /// Sorts a valid frame's particles. Weights are those of the density field. Throws LimitExceeded where they crowd.
    void assign(const ParticleFrame& frame);
    /// Fills `grid` with the base cells that a particle's support reaches; numbers stay to be given.
    void mark_reached_cells(BrickGrid& grid);
    /// Particles of level 0 per stored base cell.
    void count_per_cell(const BrickGrid& grid, Array<std::uint32_t>& counts);

    ParticleSet& operator[](std::size_t level) { return sets_[level]; }
    const ParticleSet& operator[](std::size_t level) const { return sets_[level]; }

private:
    void sort(const ParticleFrame& frame, unsigned level);
    void build_cells(ParticleSet& set);

    Workers& workers_;
    const LatticeSettings& settings_;
    Scan scan_;
    std::array<ParticleSet, particle_level_count> sets_;
    Array<std::uint64_t> reached_bricks_;
};

}  // namespace meniscus::cpu
