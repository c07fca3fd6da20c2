// A frame's particles in the CPU's memory: one sorted set per particle level.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "engine/arrays.hpp"
#include "engine/cpu/scan.hpp"
#include "engine/cpu/workers.hpp"
#include "field/lattice_settings.hpp"
#include "meniscus/mesh.hpp"
#include "particles/attributes.hpp"
#include "particles/particle_key.hpp"
#include "particles/particle_set.hpp"

namespace meniscus::cpu {

/// A particle as it is sorted where the frame brings more than positions.
struct IdentifiedKey {
    ParticleKey key;
    std::uint32_t source;  ///< its index in the frame
};

/// The particles of one level.
struct ParticleSet {
    explicit ParticleSet(const std::shared_ptr<MemoryAccount>& account);

    BrickGrid cells;
    Array<ParticleKey> keys;
    Array<IdentifiedKey> identified;  ///< keys with indices, while they are sorted
    Array<std::uint32_t> sources;     ///< each particle's index in the frame; empty for a frame without arrays
    // Only where vertices have attributes:
    Array<float> ranks;   ///< ranks for ParticleSetView, with room for whole lanes
    Array<float> values;  ///< four numbers of every particle, group after group (AttributeNumbers)
    Array<std::uint32_t> first;
    Array<std::uint64_t> cell_keys;
    // An element for every particle, and room for whole lanes beyond the last; ParticleSetView explains them.
    Array<float> x, y, z, weight;
    Array<float> fall;  ///< fall of each kernel; smooth field only
    Array<float> sums;  ///< the sum at each particle's place, while weights are found
    std::size_t count() const { return keys.size(); }
    std::int64_t cell_units = 0;
    float support = 0.0F;
    float company_support = 0.0F;  ///< support of the count of others, see LatticeSettings; smooth field only

    ParticleSetView view() const {
        return {cells.view(),  first.data(),   x.data(),   y.data(), z.data(),
                weight.data(), own_supports(), cell_units, support};
    }
    /// The same, with ranks.
    ParticleSetView ranked_view() const {
        ParticleSetView ranked = view();
        ranked.ranks = ranks.data();
        return ranked;
    }
    const float* values_of(unsigned group) const { return values.data() + group * group_size_of_numbers * count(); }
    /// The set for counts of particles around a place.
    ParticleSetView company_view() const {
        ParticleSetView company = view();
        company.fall = nullptr;
        company.support = company_support;
        return company;
    }

private:
    const float* own_supports() const { return fall.empty() ? nullptr : fall.data(); }
};

struct ParticleSets {
    ParticleSets(const std::shared_ptr<MemoryAccount>& account, Workers& workers, const LatticeSettings& settings);

    Workers& workers;
    const LatticeSettings& settings;
    std::array<ParticleSet, particle_level_count> of_level;
    Array<Point> spray;  ///< places of the spray, world units; only where the settings ask for the list
    std::uint64_t spray_particles = 0;
    // Used while particles are registered:
    Scan scan;
    Array<std::uint64_t> reached_bricks;

    /// Gives back the memory of the particles; their spray stays.
    void release();

    ParticleSet& operator[](std::size_t level) { return of_level[level]; }
    const ParticleSet& operator[](std::size_t level) const { return of_level[level]; }
};

}  // namespace meniscus::cpu
