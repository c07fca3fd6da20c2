#include "particles/particle_sets.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::cpu {
ParticleSet::ParticleSet(const std::shared_ptr<MemoryAccount>& account)
    : cells(account),
      keys(make_array<ParticleKey>(account)),
      first(make_array<std::uint32_t>(account)),
      cell_keys(make_array<std::uint64_t>(account)),
      x(make_array<float>(account)),
      y(make_array<float>(account)),
      z(make_array<float>(account)),
      weight(make_array<float>(account)),
      densities(make_array<float>(account)) {}

ParticleSets::ParticleSets(const std::shared_ptr<MemoryAccount>& account, Workers& workers,
                           const LatticeSettings& settings)
    : workers_(workers),
      settings_(settings),
      scan_(account),
      sets_{ParticleSet(account), ParticleSet(account), ParticleSet(account), ParticleSet(account)},
      reached_bricks_(make_array<std::uint64_t>(account)) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        sets_[k].support = settings.support[k];
        sets_[k].cell_units = support_cell_units(static_cast<std::int64_t>(std::ceil(settings.support[k])));
    }
}

void ParticleSets::assign(const ParticleFrame& frame) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        sort(frame, k);
        build_cells(sets_[k]);
    }
    std::uint64_t crowd = 0;
    for (const ParticleSet& set : sets_)
        for (std::uint32_t cell = 0; cell < set.cells.members; ++cell) {
            const std::uint64_t particles = set.first[cell + 1] - set.first[cell];
            crowd += particles * particles;
        }
    require_uncrowded(crowd, frame.count(), settings_);
}

void ParticleSets::sort(const ParticleFrame& frame, unsigned level) {
    ParticleSet& set = sets_[level];
    const PositionsView positions = positions_view(frame, settings_.units_per_length);
    const auto write = [&](std::size_t i, std::size_t at) {
        set.keys[at] = particle_key(positions.snapped(i), set.cell_units);
    };
    if (frame.levels.empty()) {
        resize_for_overwrite(set.keys, level == 0 ? frame.count() : 0);
        workers_.for_ranges(set.keys.size(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) write(i, i);
        });
    } else {
        const auto belongs = [&](std::size_t i) -> std::uint64_t { return frame.levels[i] == level ? 1 : 0; };
        const auto count = static_cast<std::size_t>(std::count(frame.levels.begin(), frame.levels.end(), level));
        resize_for_overwrite(set.keys, count);
        scan_.exclusive(workers_, frame.count(), belongs, [&](std::size_t i, std::uint64_t at) {
            if (belongs(i) != 0) write(i, at);
        });
    }
    workers_.sort(set.keys.data(), set.keys.data() + set.keys.size(), std::less<>());
    for (Array<float>* a : {&set.x, &set.y, &set.z, &set.weight}) {
        resize_for_overwrite(*a, set.count() + Lanes::count);
        std::fill(a->end() - Lanes::count, a->end(), 0.0F);
    }
    workers_.for_ranges(set.count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            key_position(set.keys[i], set.cell_units, set.x[i], set.y[i], set.z[i]);
            set.weight[i] = settings_.weight;
        }
    });
}

void ParticleSets::build_cells(ParticleSet& set) {
    const auto& keys = set.keys;
    const auto starts_cell = [&](std::size_t i) -> std::uint64_t {
        return i == 0 || keys[i].cell != keys[i - 1].cell ? 1 : 0;
    };
    resize_for_overwrite(set.first, keys.size() + 1);
    resize_for_overwrite(set.cell_keys, keys.size());
    const std::uint64_t cells =
        scan_.exclusive(workers_, keys.size(), starts_cell, [&](std::size_t i, std::uint64_t at) {
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

void ParticleSets::mark_reached_cells(BrickGrid& grid) {
    // Every brick that a support cell's particles may reach, each once.
    constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
    reached_bricks_.clear();
    for (const ParticleSet& set : sets_) {
        ReachedBricks last;
        for (std::size_t i = 0; i < set.cell_keys.size(); ++i) {
            const ReachedBricks reached = reached_bricks(set.cell_keys[i], set.cell_units, set.support);
            if (i > 0 && reached == last) continue;
            last = reached;
            const auto& [low, high] = reached;
            Int3 c;
            for (c.z = low.z; c.z <= high.z; ++c.z)
                for (c.y = low.y; c.y <= high.y; ++c.y)
                    for (c.x = low.x; c.x <= high.x; ++c.x) reached_bricks_.push_back(brick_key(c));
        }
    }
    std::sort(reached_bricks_.begin(), reached_bricks_.end());
    reached_bricks_.erase(std::unique(reached_bricks_.begin(), reached_bricks_.end()), reached_bricks_.end());

    resize_for_overwrite(grid.bricks, reached_bricks_.size());
    resize_for_overwrite(grid.keys, reached_bricks_.size());
    workers_.for_ranges(reached_bricks_.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            Brick& brick = grid.bricks[i];
            grid.keys[i] = reached_bricks_[i];
            brick.coordinate = brick_coordinate(reached_bricks_[i]);
            brick.clear();
            const Units3 origin{brick.coordinate.x * edge, brick.coordinate.y * edge, brick.coordinate.z * edge};
            const auto size = static_cast<float>(edge);
            for (const ParticleSet& set : sets_)
                set.view().for_each_near(
                    origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}},
                    [&](float x, float y, float z) { mark_reached(BrickMarks{brick}, x, y, z, set.support); });
            if (!settings_.has_domain) continue;
            for (int w = 0; w < Brick::words; ++w)
                brick.occupied[w] &= word_in_domain(brick.coordinate, w, settings_.domain_low, settings_.domain_high);
        }
    });
}

void ParticleSets::count_per_cell(const BrickGrid& grid, Array<std::uint32_t>& counts) {
    resize_for_overwrite(counts, grid.members);
    const ParticleSet& set = sets_[0];
    workers_.for_ranges(grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const Brick& brick = grid.bricks[i];
            const std::uint32_t last = i + 1 < grid.bricks.size() ? grid.bricks[i + 1].first : grid.members;
            std::fill(counts.begin() + brick.first, counts.begin() + last, 0U);
            constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
            const Units3 origin{brick.coordinate.x * edge, brick.coordinate.y * edge, brick.coordinate.z * edge};
            const auto size = static_cast<float>(edge);
            // Wider than needed by the support; particles of other bricks are passed over.
            set.view().for_each_near(origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}}, [&](float x, float y, float z) {
                if (x < 0.0F || y < 0.0F || z < 0.0F || x >= size || y >= size || z >= size) return;
                constexpr float cell = units_per_base_cell;
                const Int3 at{static_cast<int>(x / cell), static_cast<int>(y / cell), static_cast<int>(z / cell)};
                // Cells beyond the domain are not stored.
                if (brick.holds(index_in_brick(at))) ++counts[brick.number(index_in_brick(at))];
            });
        }
    });
}

}  // namespace meniscus::cpu
