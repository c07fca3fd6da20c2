// Step 2 on the CPU.
#include "steps/split_cells/split_cells.hpp"

#include <algorithm>

#include "engine/cpu/words.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// Puts the stored cells that may hold surface into the band, at level 1, and chooses them.
void find_band(State& state) {
    const BlocksView blocks = state.blocks();
    const BandTest test{state.settings.iso, state.settings.deep_inside};
    resize_for_overwrite(state.base_deep, state.grid.bricks.size() * Brick::words);
    const BaseVertexSets vertices{state.sign_sets().any_inside, {state.grid.view(), state.base_deep.data()}};
    // All words: those without a member are neighbors of others.
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            for (int w = 0; w < Brick::words; ++w) {
                const auto brick = static_cast<std::uint32_t>(b);
                std::uint64_t inside = 0;
                std::uint64_t deep = 0;
                for_each_cell(state.grid.bricks[b], w, state.grid.bricks[b].occupied[w],
                              [&](std::uint32_t block, int bit) {
                                  inside |= (state.inside[block] & 1) << bit;
                                  deep |= std::uint64_t{test.is_deep(blocks.value(block, 0))} << bit;
                              });
                state.sign_sets().any_inside.word(brick, w) = state.sign_sets().all_inside.word(brick, w) = inside;
                vertices.deep.word(brick, w) = inside & deep;
            }
    });
    for_each_word(state, [&](std::uint32_t brick, int w) {
        const CornerSets corners(vertices, brick, w);
        const std::uint64_t settling = state.settings.part.settling_word(state.grid.bricks[brick].coordinate, w);
        std::uint64_t band = 0;
        for_each_cell(
            state.grid.bricks[brick], w, state.grid.bricks[brick].occupied[w], [&](std::uint32_t block, int bit) {
                const bool in_band =
                    (settling >> bit & 1) != 0 && corners.may_hold_surface(bit, test, state.reaches[block].bound);
                state.level[block] = in_band ? 1 : 0;
                band |= std::uint64_t{in_band} << bit;
            });
        state.chosen_cells().word(brick, w) = band;
    });
}

/// Gives every cell of the band the level that the criterion asks for.
template <class Rule>
WantedLevel choose_levels(State& state, const Rule& level_of) {
    const BlocksView blocks = state.blocks();
    state.workers.for_ranges(state.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            if (state.level[b] != 0)
                state.level[b] = static_cast<std::uint8_t>(level_of(blocks, static_cast<std::uint32_t>(b)));
    });
    return [&state, level_of](std::uint32_t block) { return level_of(state.blocks(), block); };
}

/// The same for the curvature of the surface, 64 cells at a time.
WantedLevel choose_levels(State& state, const CurvatureRule& rule) {
    const std::size_t words = state.grid.bricks.size() * Brick::words;
    for (auto& set : state.asked_beside) resize_for_overwrite(set, words);
    const LevelSets asked{
        {{}, {}, {state.grid.view(), state.asked_beside[0].data()}, {state.grid.view(), state.asked_beside[1].data()}}};
    const CellSetView band = state.chosen_cells();
    // All words: those without a member are neighbors of others.
    for_each_brick(state, [&](std::uint32_t brick) {
        for (int w = 0; w < Brick::words; ++w) {
            std::uint64_t level2 = 0, level3 = 0;
            for_each_cell(state.grid.bricks[brick], w, band.word(brick, w), [&](std::uint32_t block, int bit) {
                state.level[block] = static_cast<std::uint8_t>(rule.of_cell(state.bends[block]));
                const int beside = rule.of_neighbor(state.bends[block]);
                level2 |= std::uint64_t{beside >= 2} << bit;
                level3 |= std::uint64_t{beside >= 3} << bit;
            });
            asked.at_least[2].word(brick, w) = level2;
            asked.at_least[3].word(brick, w) = level3;
        }
    });
    for_each_word(state, [&](std::uint32_t brick, int w) {
        const std::uint64_t cells = band.word(brick, w);
        if (cells == 0) return;
        for (int level = 2; level <= 3; ++level)
            for_each_cell(state.grid.bricks[brick], w, cells & asked.beside(level, brick, w),
                          [&](std::uint32_t block, int) {
                              state.level[block] = std::max(state.level[block], static_cast<std::uint8_t>(level));
                          });
    });
    return [&state, rule](std::uint32_t block) { return rule(state.blocks(), block); };
}

WantedLevel choose_levels(State& state, bool has_particle_levels) {
    const LatticeSettings& settings = state.settings;
    if (settings.measures_bends) return choose_levels(state, CurvatureRule{state.bends.data(), settings.tolerance});
    if (settings.counts_particles)
        return choose_levels(state,
                             CountRule{state.particle_counts.data(), settings.count_threshold, has_particle_levels});
    return choose_levels(state, UniformRule{});
}

}  // namespace

WantedLevel split_cells(State& state, NeighborSearch& search, bool has_particle_levels) {
    find_band(state);
    if (state.settings.measures_bends) measure_bends(state, search);
    WantedLevel wanted_level = choose_levels(state, has_particle_levels);
    collect_level_sets(state);
    return wanted_level;
}

}  // namespace meniscus::cpu
