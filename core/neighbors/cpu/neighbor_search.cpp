// One search for a group of clusters serves all of them, and one list of a cluster all boxes in it.
#include "neighbors/cpu/neighbor_search.hpp"

#include <algorithm>

#include "neighbors/cpu/clusters.hpp"

namespace meniscus::cpu {
namespace {

UnitBox box_of_cells(const Int3& size) {
    return {{0.0F, 0.0F, 0.0F},
            {static_cast<float>(size.x) * base_edge, static_cast<float>(size.y) * base_edge,
             static_cast<float>(size.z) * base_edge}};
}

/// The shift that makes positions relative to one base cell relative to another.
std::array<float, 3> shift_between(const Int3& from, const Int3& to) {
    const Int3 step = from - to;
    return {static_cast<float>(step.x) * base_edge, static_cast<float>(step.y) * base_edge,
            static_cast<float>(step.z) * base_edge};
}

}  // namespace

NeighborSearch::NeighborSearch(const std::shared_ptr<MemoryAccount>& account, unsigned workers, ParticleSets& sets)
    : sets_(sets) {
    for (unsigned i = 0; i < workers; ++i) lists_.emplace_back(account, sets.settings);
}

void NeighborSearch::forget() {
    for (NeighborLists& lists : lists_) lists.has_cluster = false;
}

void NeighborSearch::find_cluster(const Int3& base_cell, bool with_ranks, unsigned worker) {
    sets_.workers.go_on();
    NeighborLists& lists = lists_[worker];
    const Int3 corner = cluster_corner(base_cell);
    const bool has_enough = lists.has_ranks || !with_ranks;
    if (lists.has_cluster && has_enough && lists.cluster_corner == corner) return;
    const Int3 group = group_corner(base_cell);
    if (!lists.has_cluster || !has_enough || !(lists.group_corner == group)) {
        const UnitBox box = box_of_cells({group_size, group_size, group_size});
        for (std::size_t k = 0; k < particle_level_count; ++k)
            lists.group[k].gather(with_ranks ? sets_[k].ranked_view() : sets_[k].view(), base_cell_origin(group), box);
        lists.group_corner = group;
        lists.has_ranks = with_ranks;
    }
    const std::array<float, 3> shift = shift_between(group, corner);
    for (std::size_t k = 0; k < particle_level_count; ++k)
        lists.cluster[k].cull(lists.group[k], shift, box_of_cells(cluster_size));
    lists.cluster_corner = corner;
    lists.has_cluster = true;
}

const NeighborLists::Levels& NeighborSearch::near_cluster(const Int3& base_cell, unsigned worker) {
    find_cluster(base_cell, false, worker);
    return lists_[worker].cluster;
}

const NeighborLists::Levels& NeighborSearch::cull_cluster(const Int3& base_cell, const UnitBox& box, unsigned worker) {
    NeighborLists& lists = lists_[worker];
    const std::array<float, 3> shift = shift_between(lists.cluster_corner, base_cell);
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].cull(lists.cluster[k], shift, box);
    return lists.near;
}

const NeighborLists::Levels& NeighborSearch::near_box(const Int3& base_cell, const UnitBox& box, unsigned worker) {
    find_cluster(base_cell, false, worker);
    return cull_cluster(base_cell, box, worker);
}

const NeighborLists::Levels& NeighborSearch::nearer_box(const UnitBox& box, unsigned worker) {
    constexpr std::size_t few = 48;
    NeighborLists& lists = lists_[worker];
    std::size_t count = 0;
    for (const NeighborList& of_level : lists.near) count += of_level.view().count;
    if (count < few) return lists.near;
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.nearer[k].cull(lists.near[k], {}, box);
    return lists.nearer;
}

const NeighborLists::Levels& NeighborSearch::near_box_with_values(const Int3& base_cell, const UnitBox& box,
                                                                  unsigned group, unsigned worker) {
    find_cluster(base_cell, true, worker);
    cull_cluster(base_cell, box, worker);
    NeighborLists& lists = lists_[worker];
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].fetch_values(sets_[k].values_of(group));
    return lists.near;
}

const NeighborLists::Levels& NeighborSearch::near_box(const Units3& origin, const UnitBox& box, unsigned worker) {
    sets_.workers.go_on();
    NeighborLists& lists = lists_[worker];
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].gather(sets_[k].view(), origin, box);
    return lists.near;
}

const NeighborLists::Levels& NeighborSearch::company_near_box(const Units3& origin, const UnitBox& box,
                                                              unsigned worker) {
    sets_.workers.go_on();
    NeighborLists& lists = lists_[worker];
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].gather(sets_[k].company_view(), origin, box);
    return lists.near;
}

void NeighborSearch::even_out() {
    for (const auto levels :
         {&NeighborLists::group, &NeighborLists::cluster, &NeighborLists::near, &NeighborLists::nearer})
        for (std::size_t k = 0; k < particle_level_count; ++k) {
            std::size_t most = 0;
            for (const NeighborLists& lists : lists_) most = std::max(most, (lists.*levels)[k].capacity());
            for (NeighborLists& lists : lists_) (lists.*levels)[k].reserve(most);
        }
}

}  // namespace meniscus::cpu
