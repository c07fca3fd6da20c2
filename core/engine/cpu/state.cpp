// All arrays of the state are charged to one account.
#include "engine/cpu/state.hpp"

namespace meniscus::cpu {

State::State(const std::shared_ptr<MemoryAccount>& account, Workers& own_workers, const LatticeSettings& own_settings)
    : workers(own_workers), settings(own_settings), grid(account) {
    const auto charge = [&]<class T>(Array<T>& array) { array = make_array<T>(account); };
    for_each_block_array(charge);
    for_each_set(charge);
    charge(samples);
    charge(slots);
    charge(mixed_cells);
    charge(is_cracked);
    charge(brick_triangles);
    charge(brick_counts);
    charge(any_inside);
    charge(all_inside);
    charge(chosen);
    for (auto& set : stale) charge(set);
}

}  // namespace meniscus::cpu
