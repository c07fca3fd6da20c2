// Neighbors: the particles near a box, as a structure of arrays in the order of summation.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "engine/arrays.hpp"
#include "field/lattice_settings.hpp"
#include "field/neighbor_view.hpp"
#include "particles/particle_set.hpp"

namespace meniscus::cpu {

/// Neighbors of one particle level.
class NeighborList {
public:
    /// The data that a list may carry of its particles beside those of their kernel.
    enum class Carried : std::uint8_t { nothing, ranks, ranks_and_values };

    /// has_own_supports: whether the kernel is Poly6; lists of company have none of them even so.
    NeighborList(const std::shared_ptr<MemoryAccount>& account, bool has_own_supports, Carried carried);

    /// Searches a set for the particles that may reach into a box relative to `origin`. With ranks if the set has them.
    void gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box);
    /// Takes those of another list that may reach into a box, their positions moved by `shift`. With ranks if both may
    /// have them.
    void cull(const NeighborList& from, const std::array<float, 3>& shift, const UnitBox& box);

    /// Looks four numbers up for each particle, by its rank. of_set: those of all particles of the set.
    void fetch_values(const float* of_set);

    NeighborView view() const {
        return {x_.data(),      y_.data(),        z_.data(),
                weight_.data(), fall_.data(),     count_,
                support_,       inverse_support_, has_ranks_ ? ranks_.data() : nullptr};
    }
    /// The numbers that were looked up last.
    const float* values() const { return values_.data(); }
    std::size_t capacity() const { return x_.size(); }
    void reserve(std::size_t n);

private:
    class UnitBoxLanes;
    /// Arrays of `from` have room for whole lanes beyond the last particle.
    template <bool has_ranks>
    void append_near(const NeighborView& from, const std::array<float, 3>& shift, const UnitBoxLanes& box);
    /// is_near(i, squared distances from the box): which of a register of particles, from the i-th on, are near.
    template <bool has_own_supports, bool has_ranks, class IsNear>
    void append(const NeighborView& from, const std::array<float, 3>& shift, const UnitBoxLanes& box,
                const IsNear& is_near);

    Array<float> x_, y_, z_, weight_;
    Array<float> fall_;  ///< where particles have supports of their own, else empty
    Array<float> ranks_;
    Array<float> values_;
    bool may_have_own_supports_;
    Carried carried_;
    std::size_t count_ = 0;
    BrickHints hints_;
    bool has_own_supports_ = false;  ///< whether the listed particles have such
    bool has_ranks_ = false;
    float reach_ = 0.0F;
    float support_ = 0.0F;
    float inverse_support_ = 0.0F;
};

/// Neighbors of all particle levels: of a group of clusters (clusters.hpp), of one of them, of some points in it, and
/// of a few of these.
struct NeighborLists {
    NeighborLists(const std::shared_ptr<MemoryAccount>& account, const LatticeSettings& settings);

    using Levels = std::array<NeighborList, particle_level_count>;
    Levels group;
    Levels cluster;
    Levels near;
    Levels nearer;
    Int3 group_corner, cluster_corner;  ///< lowest base cells
    bool has_cluster = false;           ///< whether `group` and `cluster` hold their neighbors
    bool has_ranks = false;             ///< whether they have ranks, too
};

}  // namespace meniscus::cpu
