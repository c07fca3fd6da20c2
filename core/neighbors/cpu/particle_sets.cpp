// All arrays of the sets are charged to one account.
#include "neighbors/cpu/particle_sets.hpp"

namespace meniscus::cpu {

ParticleSet::ParticleSet(const std::shared_ptr<MemoryAccount>& account)
    : cells(account),
      keys(make_array<ParticleKey>(account)),
      identified(make_array<IdentifiedKey>(account)),
      sources(make_array<std::uint32_t>(account)),
      ranks(make_array<float>(account)),
      values(make_array<float>(account)),
      first(make_array<std::uint32_t>(account)),
      cell_keys(make_array<std::uint64_t>(account)),
      x(make_array<float>(account)),
      y(make_array<float>(account)),
      z(make_array<float>(account)),
      weight(make_array<float>(account)),
      fall(make_array<float>(account)),
      sums(make_array<float>(account)) {}

ParticleSets::ParticleSets(const std::shared_ptr<MemoryAccount>& account, Workers& own_workers,
                           const LatticeSettings& own_settings)
    : workers(own_workers),
      settings(own_settings),
      of_level{ParticleSet(account), ParticleSet(account), ParticleSet(account), ParticleSet(account)},
      spray(make_array<Point>(account)),
      scan(account),
      reached_bricks(make_array<std::uint64_t>(account)) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        of_level[k].support = settings.support[k];
        of_level[k].cell_units = settings.cell_units[k];
        of_level[k].company_support = settings.company_support[k];
    }
}

void ParticleSets::release() {
    for (ParticleSet& set : of_level) {
        const auto give_back = [](auto&... arrays) { (meniscus::release(arrays), ...); };
        give_back(set.keys, set.identified, set.sources, set.ranks, set.values, set.first, set.cell_keys);
        give_back(set.x, set.y, set.z, set.weight, set.fall, set.sums);
    }
}

}  // namespace meniscus::cpu
