// Rules that raise levels, one after another, until none finds a cell: how often is known on the device alone. A
// cooperative kernel rather than a loop in a graph, since it runs in and outside of graphs alike, and a wait of the
// grid costs less than the start of a kernel.
//
// A rule searches by one state of all levels and lists the cells that it finds; after a wait they are raised.
#pragma once

#include "engine/cuda/cell_bit.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/team.hpp"
#include "steps/adjust_levels/adjust_levels.hpp"

namespace meniscus::cuda {

/// The words at which rules look the first time: those of all bricks.
class AllWords {
public:
    static constexpr bool follows_raising = false;

    __device__ explicit AllWords(const State& state)
        : count_(std::uint64_t{Brick::words} * state.count(Resource::bricks)) {}
    __device__ std::uint64_t words() const { return count_; }
    __device__ std::uint32_t word(std::uint64_t i) const { return static_cast<std::uint32_t>(i); }
    __device__ void mark(std::uint32_t) const {}

private:
    std::uint64_t count_;
};

/// One kernel's rules, which look at the words of Places. If Places::follows_raising, each cell that is raised is
/// marked there with the 26 around it. All threads of the team must call all functions but find(), in the same order.
/// Before the first search the grid must wait once.
template <class Places>
class Sweeps {
public:
    Team team;
    Places places;
    SettlingTime now;  ///< which all threads of the team know

    __device__ Sweeps(const State& state, const Team& first_team, const Places& places_of_rules)
        : team(first_team), places(places_of_rules), state_(state), levels_(state.level_sets()) {
        if (team.is_first_thread()) state_.counts->found[0] = state_.counts->found_alone[0] = 0;
    }

    /// The number of the next search or of the one that is going on; no two searches have the same.
    __device__ std::uint32_t search() const { return team.is_alone() ? ~searches_alone_ : searches_ + 1; }

    /// Called by a rule for a cell that shall go up. Several threads may find the same cell.
    __device__ void find(std::uint32_t block) const {
        const CellBit cell(state_, block);
        if ((cell.put_into(state_.raised) & cell.bit) == 0) list(block);
    }
    /// Ends a rule's search; returns how many cells it has found.
    __device__ std::uint32_t end_search() {
        // Three counts in turn: one is added to, one may still be read, one is cleared for the next search.
        // A block that goes on alone has its own: others may read the grid's long after.
        if (team.is_first_thread()) *count(1) = 0;
        team.wait();
        const std::uint32_t found = *count();
        if (team.is_alone())
            ++searches_alone_;
        else
            ++searches_;
        return found;
    }
    /// Raises the `found` cells of the last search to new_level(block); a cell keeps its level where that is 0.
    template <class NewLevel>
    __device__ void raise_found(std::uint32_t found, const NewLevel& new_level) const {
        each_around(found, [&](std::uint32_t block, unsigned slot) {
            if (slot == own_slot) raise(block, new_level(block));
        });
        team.wait();
    }

    /// Balance and promotion, until nothing changes.
    __device__ void adjust_levels() {
        now.step = SettlingTime::adjusting;
        for (bool has_finer = true;; ++now.step) {
            if (has_finer) balance();
            ++now.step;
            if (can_share_edges(places.words(), team.threads()))
                promote<edge_groups>();
            else
                promote<1>();
            const std::uint32_t promotion = search();
            const std::uint32_t found = end_search();
            if (found == 0) return;
            has_finer = static_cast<volatile std::uint32_t&>(state_.counts->last_to_finest) == promotion;
            raise_found(found, [&](std::uint32_t block) { return state_.level[block] + 1; });
        }
    }

    /// One block is no slower than the grid as long as its threads share the edges of each word, since the grid waits
    /// for itself at each search.
    __device__ static bool suit_one_block(std::uint64_t words) { return can_share_edges(words, block_threads); }

private:
    /// Threads that are left over share the twelve edges of a word's cells, six of them each word.
    __device__ static bool can_share_edges(std::uint64_t words, std::uint64_t threads) {
        return words * edge_groups <= 2 * threads;
    }
    /// The number of cells that this search has found, or the one `later` searches after it.
    __device__ volatile std::uint32_t* count(std::uint32_t later = 0) const {
        return team.is_alone() ? &state_.counts->found_alone[(searches_alone_ + later) % 3]
                               : &state_.counts->found[(searches_ + later) % 3];
    }
    __device__ void list(std::uint32_t block) const {
        state_.found_cells()[atomicAdd(const_cast<std::uint32_t*>(count()), 1U)] = block;
    }
    /// Calls visit(block, slot) for the cells that were found. Where Places follow, it does so for all 27 slots, each
    /// in a thread of its own, and marks the cells there; else for own_slot alone.
    template <class Visit>
    __device__ void each_around(std::uint32_t found, const Visit& visit) const {
        constexpr unsigned slots = Places::follows_raising ? neighbor_slots : 1;
        const BlocksView blocks = state_.blocks();
        team.loop().template each<std::uint64_t>(std::uint64_t{found} * slots, [&](std::uint64_t i) {
            const std::uint32_t block = state_.found_cells()[i / slots];
            const unsigned slot = slots == 1 ? own_slot : static_cast<unsigned>(i % slots);
            visit(block, slot);
            if constexpr (Places::follows_raising) {
                const std::uint32_t near = blocks.neighbor(block, neighbor_offset(static_cast<int>(slot)));
                if (near != no_index) places.mark(near);
            }
        });
    }
    /// Before the cell goes up.
    __device__ void note(std::uint32_t block, int level) const {
        if (!state_.settings.part.is_whole) state_.raise_times[block].note(state_.level[block], level, now);
    }
    __device__ void raise(std::uint32_t block, int level) const {
        const CellBit cell(state_, block);
        cell.take_out_of(state_.raised);
        if (level == 0) return;
        const int before = state_.level[block];
        note(block, level);
        for (int l = 1; l <= 3; ++l)
            if (before < l && l <= level) cell.put_into(levels_.at_least[l].words);
        state_.level[block] = static_cast<std::uint8_t>(level);
    }

    /// Calls visit(brick, w, sharer) for the words, once for each of the threads that share a word.
    template <unsigned threads, class Visit>
    __device__ void each_word(const Visit& visit) const {
        team.template each_part<threads>(places.words(), [&](std::uint64_t i, unsigned part) {
            const std::uint32_t word = places.word(i);
            visit(word / Brick::words, static_cast<int>(word % Brick::words), part);
        });
    }
    __device__ void balance() {
        each_word<1>([&](std::uint32_t brick, int w, unsigned) {
            const std::uint64_t cells = unbalanced_cells(levels_, brick, w);
            if (cells == 0) return;
            raise_cells(levels_, state_.level, brick, w, cells, [&](std::uint32_t block) {
                if (Places::follows_raising) list(block);
                note(block, 2);
                return 2;
            });
        });
        if constexpr (Places::follows_raising) {
            const std::uint32_t found = end_search();
            if (found == 0) return;
            each_around(found, [](std::uint32_t, unsigned) {});
        }
        team.wait();
    }
    template <unsigned threads>
    __device__ void promote() const {
        each_word<threads>([&](std::uint32_t brick, int w, unsigned first) {
            std::uint64_t left = cells_to_promote<threads>(levels_, brick, w, first);
            // Only cells of the finest level unbalance others.
            if ((left & levels_.is_at_least(2, brick, w)) != 0) state_.counts->last_to_finest = search();
            for (; left != 0; left &= left - 1) find(state_.bricks[brick].number(64 * w + lowest_bit(left)));
        });
    }

    const State& state_;
    LevelSets levels_;
    std::uint32_t searches_ = 0;        ///< number of searches by the grid
    std::uint32_t searches_alone_ = 0;  ///< number of searches by its first block
};

}  // namespace meniscus::cuda
