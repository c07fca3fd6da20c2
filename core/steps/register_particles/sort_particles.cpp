// The particles' order on the CPU, and their support cells: particles are sorted as keys and read back from them.
#include <algorithm>

#include "particles/payload.hpp"
#include "particles/positions.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// Calls write(particle's index in the frame, at) for the particles of a level, at = 0, 1, ...; resize(n) first.
template <class Resize, class Write>
void for_each_of_level(ParticleSets& sets, const ParticleFrame& frame, unsigned level, const Resize& resize,
                       const Write& write) {
    if (frame.levels.empty()) {
        const std::size_t count = level == 0 ? frame.count() : 0;
        resize(count);
        sets.workers.for_ranges(count, 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) write(i, i);
        });
        return;
    }
    const auto belongs = [&](std::size_t i) -> std::uint64_t { return frame.levels[i] == level ? 1 : 0; };
    resize(static_cast<std::size_t>(std::count(frame.levels.begin(), frame.levels.end(), level)));
    sets.scan.exclusive(sets.workers, frame.count(), belongs, [&](std::size_t i, std::uint64_t at) {
        if (belongs(i) != 0) write(i, at);
    });
}

/// Sorts keys alone: where only positions matter, particles of the same key are interchangeable.
void sort_keys(ParticleSets& sets, ParticleSet& set, const ParticleFrame& frame, unsigned level) {
    const PositionsView positions = positions_view(frame, sets.settings.units_per_length);
    for_each_of_level(
        sets, frame, level, [&](std::size_t n) { resize_for_overwrite(set.keys, n); },
        [&](std::size_t i, std::size_t at) { set.keys[at] = particle_key(positions.snapped(i), set.cell_units); });
    sets.workers.sort(set.keys.data(), set.keys.data() + set.keys.size(), std::less<>());
    set.sources.clear();
}

/// Sorts keys with the particles' indices, equal keys by their payload: the result does not depend on the order of the
/// frame.
void sort_identified_keys(ParticleSets& sets, ParticleSet& set, const ParticleFrame& frame, unsigned level) {
    const PositionsView positions = positions_view(frame, sets.settings.units_per_length);
    for_each_of_level(
        sets, frame, level, [&](std::size_t n) { resize_for_overwrite(set.identified, n); },
        [&](std::size_t i, std::size_t at) {
            set.identified[at] = {particle_key(positions.snapped(i), set.cell_units), static_cast<std::uint32_t>(i)};
        });
    const PayloadView payload = payload_view(frame);
    sets.workers.sort(set.identified.data(), set.identified.data() + set.identified.size(),
                      [&](const IdentifiedKey& a, const IdentifiedKey& b) {
                          if (a.key < b.key) return true;
                          return !(b.key < a.key) && payload.before(a.source, b.source);
                      });
    resize_for_overwrite(set.keys, set.identified.size());
    resize_for_overwrite(set.sources, set.identified.size());
    sets.workers.for_ranges(set.identified.size(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            set.keys[i] = set.identified[i].key;
            set.sources[i] = set.identified[i].source;
        }
    });
}

/// Sorts the particles of one level.
void sort_level(ParticleSets& sets, const ParticleFrame& frame, unsigned level) {
    ParticleSet& set = sets[level];
    if (frame.arrays.empty())
        sort_keys(sets, set, frame, level);
    else
        sort_identified_keys(sets, set, frame, level);
    for (Array<float>* a : {&set.x, &set.y, &set.z, &set.weight}) {
        resize_for_overwrite(*a, set.count() + WideLanes::count);
        std::fill(a->end() - WideLanes::count, a->end(), 0.0F);
    }
    sets.workers.for_ranges(set.count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            key_position(set.keys[i], set.cell_units, set.x[i], set.y[i], set.z[i]);
            set.weight[i] = sets.settings.weight;
        }
    });
}

/// Stores the numbers of the sorted particles of a level that vertices need.
void store_values(ParticleSets& sets, ParticleSet& set, const ParticleFrame& frame, const AttributeNumbers& numbers) {
    const PayloadView payload = payload_view(frame);
    const std::size_t n = set.count();
    resize_for_overwrite(set.ranks, n + WideLanes::count);
    std::fill(set.ranks.end() - WideLanes::count, set.ranks.end(), 0.0F);
    resize_for_overwrite(set.values, n * numbers.shape.groups() * group_size_of_numbers);
    sets.workers.for_ranges(n, 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            set.ranks[i] = AttributeNumber::as_float(static_cast<std::uint32_t>(i));
        for (unsigned g = 0; g < numbers.shape.groups(); ++g)
            for (unsigned k = 0; k < group_size_of_numbers; ++k) {
                float* const out = set.values.data() + g * group_size_of_numbers * n + k;
                const AttributeNumber number = numbers.group(g)[k];
                const bool exists = k < numbers.shape.count(g);
                for (std::size_t i = begin; i < end; ++i)
                    out[group_size_of_numbers * i] =
                        exists ? number.of_particle(payload.data[number.array], set.sources[i]) : 0.0F;
            }
    });
}

/// Stores the support cells of a sorted set.
void store_support_cells(ParticleSets& sets, ParticleSet& set) {
    const auto& keys = set.keys;
    const auto starts_cell = [&](std::size_t i) -> std::uint64_t {
        return i == 0 || keys[i].cell != keys[i - 1].cell ? 1 : 0;
    };
    resize_for_overwrite(set.first, keys.size() + 1);
    resize_for_overwrite(set.cell_keys, keys.size());
    const std::uint64_t cells =
        sets.scan.exclusive(sets.workers, keys.size(), starts_cell, [&](std::size_t i, std::uint64_t at) {
            if (starts_cell(i) == 0) return;
            set.first[at] = static_cast<std::uint32_t>(i);
            set.cell_keys[at] = keys[i].cell;
        });
    set.first[cells] = static_cast<std::uint32_t>(keys.size());
    set.cell_keys.resize(cells);

    const auto starts_brick = [&](std::size_t i) {
        return i == 0 || set.cell_keys[i] >> brick_index_bits != set.cell_keys[i - 1] >> brick_index_bits;
    };
    set.cells.bricks.clear();
    set.cells.keys.clear();
    for (std::size_t i = 0; i < cells; ++i) {
        if (i % 65536 == 0) sets.workers.go_on();
        if (starts_brick(i)) {
            Brick& brick = set.cells.bricks.emplace_back();
            brick.coordinate = key_brick(set.cell_keys[i]);
            brick.clear();
            set.cells.keys.push_back(brick_key(brick.coordinate));
        }
        const int index = key_index(set.cell_keys[i]);
        set.cells.bricks.back().occupied[index >> 6] |= std::uint64_t{1} << (index & 63);
    }
    std::uint32_t members = 0;
    for (Brick& brick : set.cells.bricks) {
        brick.first = members;
        members += brick.count();
    }
    set.cells.members = members;
}

}  // namespace

void sort_particles(ParticleSets& sets, const ParticleFrame& frame, const AttributeNumbers& numbers) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        sort_level(sets, frame, k);
        if (numbers.shape.groups() != 0) store_values(sets, sets[k], frame, numbers);
        store_support_cells(sets, sets[k]);
    }
}

}  // namespace meniscus::cpu
