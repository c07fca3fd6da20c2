// The search for neighbors: the particles near clusters of base cells and near boxes in them, found once for all that
// ask.
#pragma once

#include <memory>
#include <vector>

#include "neighbors/cpu/neighbor_list.hpp"
#include "neighbors/cpu/particle_sets.hpp"

namespace meniscus::cpu {

/// Each worker has lists of its own, valid until it asks again. Every search asks Workers::go_on(): a search and the
/// sums over its neighbors are the longest piece of work.
class NeighborSearch {
public:
    NeighborSearch(const std::shared_ptr<MemoryAccount>& account, unsigned workers, ParticleSets& sets);

    /// Drops all lists, after particles or their weights have changed.
    void forget();

    /// The particles near the cluster (clusters.hpp) of a base cell, relative to the cluster's lowest corner.
    const NeighborLists::Levels& near_cluster(const Int3& base_cell, unsigned worker);
    /// The particles near a box, both relative to a base cell's corner.
    const NeighborLists::Levels& near_box(const Int3& base_cell, const UnitBox& box, unsigned worker);
    /// The particles of the last list that are near a box within its own; all of them where a search would not pay.
    const NeighborLists::Levels& nearer_box(const UnitBox& box, unsigned worker);
    /// The same as near_box(), each with its numbers of a group (NeighborList::values).
    const NeighborLists::Levels& near_box_with_values(const Int3& base_cell, const UnitBox& box, unsigned group,
                                                      unsigned worker);
    /// The particles near a box, both relative to an origin that may lie anywhere.
    const NeighborLists::Levels& near_box(const Units3& origin, const UnitBox& box, unsigned worker);
    /// The particles within the company's support of the box.
    const NeighborLists::Levels& company_near_box(const Units3& origin, const UnitBox& box, unsigned worker);

    /// Gives every worker room for the longest lists that any has met, so that a warm frame allocates nothing.
    void even_out();

    const ParticleSets& sets() const { return sets_; }

private:
    void find_cluster(const Int3& base_cell, bool with_ranks, unsigned worker);
    const NeighborLists::Levels& cull_cluster(const Int3& base_cell, const UnitBox& box, unsigned worker);

    ParticleSets& sets_;
    std::vector<NeighborLists> lists_;  ///< lists of each worker
};

}  // namespace meniscus::cpu
