// One search for a cluster of eight base cells serves all boxes in it.
#include "engine/cpu/neighborhoods.hpp"

#include <algorithm>

namespace meniscus::cpu {
Neighborhoods::Neighborhoods(const std::shared_ptr<MemoryAccount>& account, unsigned workers, ParticleSets& sets)
    : sets_(sets) {
    for (unsigned i = 0; i < workers; ++i) lists_.emplace_back(account, sets.settings.has_own_supports);
}

void Neighborhoods::forget() {
    for (CandidateLists& lists : lists_) lists.has_cluster = false;
}

const CandidateLists::Levels& Neighborhoods::near_cluster(const Int3& base_cell, unsigned worker) {
    sets_.workers.go_on();
    CandidateLists& lists = lists_[worker];
    const Int3 corner{base_cell.x & ~1, base_cell.y & ~1, base_cell.z & ~1};
    if (!lists.has_cluster || !(lists.corner == corner)) {
        const UnitBox box{{0.0F, 0.0F, 0.0F}, {2 * base_edge, 2 * base_edge, 2 * base_edge}};
        for (std::size_t k = 0; k < particle_level_count; ++k)
            lists.cluster[k].gather(sets_[k].view(), base_cell_origin(corner), box);
        lists.corner = corner;
        lists.has_cluster = true;
    }
    return lists.cluster;
}

const CandidateLists::Levels& Neighborhoods::near_box(const Int3& base_cell, const UnitBox& box, unsigned worker) {
    const CandidateLists::Levels& cluster = near_cluster(base_cell, worker);
    CandidateLists& lists = lists_[worker];
    const Int3 offset = base_cell - lists.corner;
    const std::array<float, 3> shift{static_cast<float>(-offset.x) * base_edge,
                                     static_cast<float>(-offset.y) * base_edge,
                                     static_cast<float>(-offset.z) * base_edge};
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].cull(cluster[k], shift, box);
    return lists.near;
}

const CandidateLists::Levels& Neighborhoods::near_box(const Units3& origin, const UnitBox& box, unsigned worker) {
    sets_.workers.go_on();
    CandidateLists& lists = lists_[worker];
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].gather(sets_[k].view(), origin, box);
    return lists.near;
}

const CandidateLists::Levels& Neighborhoods::company_near_box(const Units3& origin, const UnitBox& box,
                                                              unsigned worker) {
    sets_.workers.go_on();
    CandidateLists& lists = lists_[worker];
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].gather(sets_[k].company_view(), origin, box);
    return lists.near;
}

void Neighborhoods::even_out() {
    for (const auto levels : {&CandidateLists::cluster, &CandidateLists::near})
        for (std::size_t k = 0; k < particle_level_count; ++k) {
            std::size_t most = 0;
            for (const CandidateLists& lists : lists_) most = std::max(most, (lists.*levels)[k].capacity());
            for (CandidateLists& lists : lists_) (lists.*levels)[k].reserve(most);
        }
}

}  // namespace meniscus::cpu
