// The rounds in which the band settles, but for their samples: rules look for cells to raise, first at all faces
// between levels, then around the cells that were raised.
#pragma once

#include <cstdint>

#include "engine/cuda/state.hpp"
#include "engine/cuda/team.hpp"
#include "engine/cuda/warp.hpp"
#include "lattice/levels_around.hpp"
#include "steps/adjust_levels/sweeps.hpp"
#include "steps/sample_field/sample_field.hpp"
#include "steps/sample_field/slivers.hpp"
#include "steps/sample_field/stale_cells.hpp"
#include "steps/sample_field/wanted_points.hpp"

namespace meniscus::cuda {

/// The levels around a block, which eight neighboring lanes give: each looks at one of the eight cells.
__device__ inline LevelsAround levels_around_together(const BlocksView& blocks, std::uint32_t block) {
    const unsigned lane = lane_index();
    const Int3 offset = LevelsAround::offset(static_cast<int>(lane % 8));
    const int level = block == no_index ? 0 : blocks.level_or_none(blocks.neighbor(block, offset));
    LevelsAround around;
    for (int l = 1; l <= 3; ++l)
        around.at_least[l] = static_cast<int>(__ballot_sync(all_lanes, level >= l ? 1 : 0) >> (lane & ~7U) & 0xFF);
    return around;
}

/// A cell's face in Counts::faces_to_settle.
struct ListedFace {
    std::uint32_t block;
    unsigned face;

    __device__ explicit ListedFace(std::uint64_t entry)
        : block(static_cast<std::uint32_t>(entry)), face(static_cast<unsigned>(entry >> 32)) {}
    __device__ static std::uint64_t entry(std::uint32_t block, unsigned face) {
        return block | std::uint64_t{face} << 32;
    }
};

/// The settling of the band, which all threads of the grid go through.
template <Slivers slivers>
class Settling {
public:
    __device__ explicit Settling(const State& state)
        : state_(state), blocks_(state.blocks()), sweeps_(state, Team::grid(), StaleCells(state)) {}

    /// Lists the faces at which a cell may go up by what is sampled so far.
    __device__ void begin() {
        const LevelSets levels = state_.level_sets();
        Team::grid().each_part<CellFace::count>(
            std::uint64_t{Brick::words} * state_.count(Resource::bricks), [&](std::uint64_t i, unsigned face) {
                const auto word = static_cast<std::uint32_t>(i);
                if (face == 0) state_.is_stale()[word] = 0;
                const Brick& brick = state_.bricks[word / Brick::words];
                const std::uint32_t w = word % Brick::words;
                std::uint64_t cells = brick.occupied[w];
                if (cells != 0)
                    cells &= levels.below(word / Brick::words, static_cast<int>(w), CellFace(face).offset());
                if (cells == 0) return;
                std::uint32_t at =
                    atomicAdd(&state_.counts->faces_to_settle, static_cast<std::uint32_t>(popcount(cells)));
                for (; cells != 0; cells &= cells - 1)
                    state_.faces_to_settle()[at++] =
                        ListedFace::entry(brick.number(static_cast<int>(64 * w) + lowest_bit(cells)), face);
            });
        sweeps_.team.wait();
        faces_ = static_cast<volatile std::uint32_t&>(state_.counts->faces_to_settle);
    }

    /// Raises the cells that the rules find, adjusts, and lists what to sample then; returns whether there were any.
    /// The first block does it alone where a wait of the grid would cost more than the work.
    __device__ bool raise() {
        sweeps_.team = Team::fit_for(tests(), 1);
        ++sweeps_.now.round;
        std::uint32_t found = 0;
        if (sweeps_.team.has_this_thread()) {
            const std::uint32_t search = sweeps_.search();
            // Before any thread marks others: all must choose the same team by it.
            const std::uint64_t words = sweeps_.places.words();
            test_faces(true);
            test_stale_cells(true);
            found = sweeps_.end_search();
            if (found == 0 && !sweeps_.team.is_alone()) return false;
            if (found != 0) raise_found(found, search, words);
            if (sweeps_.team.is_first_thread()) state_.counts->is_settled = found == 0 ? 1 : 0;
        }
        Team::grid().wait();
        if (static_cast<volatile std::uint32_t&>(state_.counts->is_settled) != 0) return false;
        faces_ = 0;
        stale_count_ = sweeps_.places.count();
        GridLoop{}.each_together<std::uint64_t>(std::uint64_t{8} * stale_count_, [&](std::uint64_t i, bool exists) {
            const std::uint32_t block = exists ? sweeps_.places[i / 8] : no_index;
            const BlockMask wanted = corner_points(levels_around_together(blocks_, block));
            const bool is_first = exists && i % 8 == 0;
            if (is_first) state_.corner_points[block] = wanted;
            list_if_wanted(state_, List::later_round, is_first ? block : no_index, wanted,
                           [](auto* places, std::uint32_t n) { return take_places(places, n); });
        });
        Team::grid().wait();
        return true;
    }

private:
    __device__ std::uint64_t tests() const { return faces_ + std::uint64_t{CellFace::count} * stale_count_; }

    /// Both rules look at the same levels. A cell that joins the band changes what slivers there are: they are looked
    /// for anew.
    __device__ void test(std::uint32_t block, const CellFace& face, bool joins) const {
        if (state_.level[block] == 0) {
            if (!joins || !joins_band(blocks_, block, face) || !state_.settings.part.settles(blocks_.coordinate(block)))
                return;
            state_.counts->last_joining = sweeps_.search();
        } else if (slivers == Slivers::kept || !misses_surface(blocks_, block, face)) {
            return;
        }
        sweeps_.find(block);
    }
    __device__ void test_faces(bool joins) const {
        sweeps_.team.loop().each(faces_, [&](std::uint32_t i) {
            const ListedFace listed(state_.faces_to_settle()[i]);
            test(listed.block, CellFace(listed.face), joins);
        });
    }
    __device__ void test_stale_cells(bool joins) const {
        sweeps_.team.each_part<CellFace::count>(
            stale_count_, [&](std::uint64_t i, unsigned face) { test(sweeps_.places[i], CellFace(face), joins); });
    }
    /// words: number of words that hold stale cells, around all of which the sweeps look however few cells go up.
    __device__ void raise_found(std::uint32_t found, std::uint32_t search, std::uint64_t words) {
        if (sweeps_.suit_one_block(words))
            sweeps_.team = sweeps_.team.narrowed_to(std::uint64_t{neighbor_slots} * found, 4);
        if (!sweeps_.team.has_this_thread()) return;
        // All have read the last round's list.
        if (sweeps_.team.is_first_thread()) state_.counts->listed[static_cast<int>(List::later_round)] = 0;
        if (static_cast<volatile std::uint32_t&>(state_.counts->last_joining) == search) {
            sweeps_.now.step = SettlingTime::joining;
            sweeps_.raise_found(
                found, [&](std::uint32_t block) { return state_.level[block] == 0 ? state_.wanted_level[block] : 0; });
            stale_count_ = sweeps_.places.count();
            test_faces(false);
            test_stale_cells(false);
            found = sweeps_.end_search();
        }
        sweeps_.now.step = SettlingTime::slivers;
        sweeps_.raise_found(found, [&](std::uint32_t block) { return state_.level[block] + 1; });
        sweeps_.adjust_levels();
    }

    const State& state_;
    BlocksView blocks_;
    Sweeps<StaleCells> sweeps_;
    std::uint32_t faces_ = 0;        ///< number of faces to be tested in the first round
    std::uint32_t stale_count_ = 0;  ///< number of stale cells when the round began
};

}  // namespace meniscus::cuda
