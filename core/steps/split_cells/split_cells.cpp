// Step 2 on the CPU.
#include "steps/split_cells/split_cells.hpp"

#include "engine/cpu/words.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// Puts the stored cells that may hold surface into the band, at level 1, and chooses them.
void find_band(State& s) {
    const BlocksView blocks = s.blocks();
    const BandTest test{s.settings.iso, s.settings.deep_inside};
    resize_for_overwrite(s.base_deep, s.grid.bricks.size() * Brick::words);
    const BaseVertexSets vertices{s.sign_sets().any_inside, {s.grid.view(), s.base_deep.data()}};
    // All words: those without a member are neighbors of others.
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            for (int w = 0; w < Brick::words; ++w) {
                const auto brick = static_cast<std::uint32_t>(b);
                std::uint64_t inside = 0;
                std::uint64_t deep = 0;
                for_each_cell(s.grid.bricks[b], w, s.grid.bricks[b].occupied[w], [&](std::uint32_t block, int bit) {
                    inside |= (s.inside[block] & 1) << bit;
                    deep |= std::uint64_t{test.is_deep(blocks.value(block, 0))} << bit;
                });
                s.sign_sets().any_inside.word(brick, w) = s.sign_sets().all_inside.word(brick, w) = inside;
                vertices.deep.word(brick, w) = inside & deep;
            }
    });
    for_each_word(s, [&](std::uint32_t brick, int w) {
        const CornerSets corners(vertices, brick, w);
        std::uint64_t band = 0;
        for_each_cell(s.grid.bricks[brick], w, s.grid.bricks[brick].occupied[w], [&](std::uint32_t block, int bit) {
            const bool in_band = corners.may_hold_surface(bit, test, s.reaches[block].bound);
            s.level[block] = in_band ? 1 : 0;
            band |= std::uint64_t{in_band} << bit;
        });
        s.chosen_cells().word(brick, w) = band;
    });
}

/// Gives every cell of the band the level that the criterion asks for.
template <class Rule>
WantedLevel choose_levels(State& s, const Rule& level_of) {
    const BlocksView blocks = s.blocks();
    s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            if (s.level[b] != 0)
                s.level[b] = static_cast<std::uint8_t>(level_of(blocks, static_cast<std::uint32_t>(b)));
    });
    return [&s, level_of](std::uint32_t block) { return level_of(s.blocks(), block); };
}

WantedLevel choose_levels(State& s, bool has_particle_levels) {
    const LatticeSettings& settings = s.settings;
    if (settings.measures_bends) return choose_levels(s, CurvatureRule{s.bends.data(), settings.tolerance});
    if (settings.counts_particles)
        return choose_levels(s, CountRule{s.particle_counts.data(), settings.count_threshold, has_particle_levels});
    return choose_levels(s, UniformRule{});
}

}  // namespace

WantedLevel split_cells(State& s, NeighborSearch& near, bool has_particle_levels) {
    find_band(s);
    if (s.settings.measures_bends) measure_bends(s, near);
    WantedLevel wanted_level = choose_levels(s, has_particle_levels);
    collect_level_sets(s);
    return wanted_level;
}

}  // namespace meniscus::cpu
