// A frame's work, estimated before it is done and held against that of evenly spread particles
// (core/README.md#work-20-and-1024).
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "field/lattice_settings.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/error.hpp"
#include "particles/particle_key.hpp"

namespace meniscus {

/// The work that is never refused, in pairs of a place at which the field is summed and a particle near it.
inline constexpr double always_bearable = 268'435'456.0;

/// One probe for this number of particles, next to each other in their order: its neighbors are counted.
inline constexpr std::uint32_t particles_per_probe = 1024;
/// Frames of fewer particles are not probed: all of their pairs are always_bearable.
inline constexpr std::uint32_t fewest_probed = 16'384;

MENISCUS_HD inline std::uint32_t probe_count(std::uint64_t particles) {
    return particles <= fewest_probed
               ? 0
               : static_cast<std::uint32_t>((particles + particles_per_probe - 1) / particles_per_probe);
}

/// The bits of a number, each spread over all (the finalizer of splitmix64).
MENISCUS_HD inline std::uint64_t spread_bits(std::uint64_t v) {
    v = (v ^ v >> 30) * 0xBF58476D1CE4E5B9ULL;
    v = (v ^ v >> 27) * 0x94D049BB133111EBULL;
    return v ^ v >> 31;
}

/// The rank of a probed particle. seed: of the frame, so that no one can place particles between all probes.
MENISCUS_HD inline std::uint32_t probed_particle(std::uint32_t probe, std::uint64_t seed, std::uint64_t particles) {
    const std::uint64_t first = std::uint64_t{probe} * particles_per_probe;
    const std::uint64_t left = particles - first;
    const std::uint64_t count = left < particles_per_probe ? left : particles_per_probe;
    return static_cast<std::uint32_t>(first + spread_bits(seed + probe) % count);
}

/// A particle's share in the seed, which is the sum over the first particle of every probe.
MENISCUS_HD inline std::uint64_t key_bits(const ParticleKey& key) {
    return spread_bits(key.cell ^ spread_bits(key.place));
}

/// Whether two places are neighbors, by their difference in units.
MENISCUS_HD inline bool is_neighbor(float dx, float dy, float dz, float support) {
    return dx * dx + dy * dy + dz * dz < support * support;
}

/// The number of particles of a level within a support of one of them, where they are at rest.
struct EvenNeighbors {
    MENISCUS_HD double operator()(const LatticeSettings& s, unsigned level) const {
        const double reach = static_cast<double>(s.support[level]) / (s.rest_distance * (1U << level));
        return 1.0 + 4.18879 * reach * reach * reach;
    }
};

/// The number of particles of a level whose support, taken as a cube, meets a base cell, where they are at rest.
struct EvenNearBaseCell {
    MENISCUS_HD double operator()(const LatticeSettings& s, unsigned level) const {
        const double edge =
            (2.0 * static_cast<double>(s.support[level]) + units_per_base_cell) / (s.rest_distance * (1U << level));
        return 1.0 + edge * edge * edge;
    }
};

/// The number of base cells that is never refused, about a second's work: each cell costs some, however few particles
/// are near it.
inline constexpr double always_bearable_cells = 1'048'576.0;

/// The number of base cells that a cube of particles of a level reaches, where they are at rest.
MENISCUS_HD inline double even_base_cells(const LatticeSettings& s, unsigned level, std::uint64_t particles) {
    if (particles == 0) return 0.0;
    const double edge = cbrt(static_cast<double>(particles)) * s.rest_distance * (1U << level) +
                        2.0 * static_cast<double>(s.support[level]);
    const double cells = edge / units_per_base_cell + 1.0;
    return cells * cells * cells;
}

/// The most base cells that a frame may reach.
MENISCUS_HD inline double most_base_cells(const LatticeSettings& s, double even_cells) {
    const double most = s.work_limit * even_cells;
    return most > always_bearable_cells ? most : always_bearable_cells;
}

/// The work at `places` where particles are at rest. EvenNear: number of those near a place. has_level(k): whether
/// there are particles of a level.
template <class EvenNear, class HasLevel>
MENISCUS_HD double even_work(const LatticeSettings& s, std::uint64_t places, const HasLevel& has_level) {
    double near = 0.0;
    for (unsigned k = 0; k < particle_level_count; ++k)
        if (has_level(k)) near += EvenNear{}(s, k);
    return near * static_cast<double>(places);
}
/// The work at all particles, by the probes' neighbors.
MENISCUS_HD inline double work_at_particles(std::uint64_t neighbors, std::uint64_t particles) {
    return static_cast<double>(neighbors) * (static_cast<double>(particles) / probe_count(particles));
}

/// The upper limit of the work for a frame.
MENISCUS_HD inline double most_work(const LatticeSettings& s, double even_work) {
    const double most = s.work_limit * even_work;
    return most > always_bearable ? most : always_bearable;
}

inline std::string rounded(double v) {
    return std::to_string(static_cast<std::uint64_t>(v));
}

[[noreturn]] inline void throw_too_many_base_cells(std::uint64_t cells, double even_cells, const LatticeSettings& s) {
    throw LimitExceeded("the particles reach " + std::to_string(cells) + " base cells, at most " +
                        rounded(most_base_cells(s, even_cells)) +
                        " are sampled (as many particles, evenly spread, reach " + rounded(even_cells) +
                        "): use a larger cell size, or leave particles out that are far from all others");
}

[[noreturn]] inline void throw_too_much_work(const char* places, double work, double even_work,
                                             const LatticeSettings& s) {
    throw LimitExceeded("the field at " + std::string(places) + " is a sum over about " + rounded(work) +
                        " particles near them, at most " + rounded(most_work(s, even_work)) +
                        " are summed over (as many particles, evenly spread, take " + rounded(even_work) +
                        "): are the positions in the unit of the particle radius, and not all in few places?");
}

}  // namespace meniscus
