// All arrays of the state are charged to one account.
#include "engine/cpu/state.hpp"

namespace meniscus::cpu {

State::State(const std::shared_ptr<MemoryAccount>& account, Workers& own_workers, const LatticeSettings& own_settings)
    : workers(own_workers), settings(own_settings), grid(account) {
    const auto charge = [&]<class T>(Array<T>& array) { array = make_array<T>(account); };
    const auto charge_named = [&](const char*, auto& array) { charge(array); };
    for_each_block_array(charge_named);
    for_each_set(charge_named);
    charge(samples);
    charge(slots);
    charge(raise_times);
    charge(border_hashes);
    charge(mixed_cells);
    charge(is_cracked);
    charge(brick_triangles);
    charge(brick_counts);
    charge(any_inside);
    charge(all_inside);
    charge(chosen);
    for (auto& set : stale) charge(set);
    for (auto& set : asked_beside) charge(set);
}

void State::release_samples() {
    release(samples);
    release(wanted_points);
    release(sampled);
    release(first_sample);
    release(particle_counts);
    release(reaches);
    release(bends);
    release(raise_times);
}

}  // namespace meniscus::cpu
