// Rules that raise the levels of some cells, swept over all cells by a grid of threads that waits for itself between
// sweeps: how many sweeps there are is known on the device alone. A cooperative kernel rather than a loop in a graph,
// since it runs in and outside of graphs alike, and a wait of the grid costs less than the start of a kernel.
#pragma once

#include <cooperative_groups.h>

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/adjust_levels/adjust_levels.hpp"

namespace meniscus::cuda {

/// The sweeps of one cooperative kernel. All threads of the grid must call all functions, in the same order.
class Sweeps {
public:
    __device__ explicit Sweeps(const State& f)
        : f_(f), levels_(f.level_sets()), words_(std::uint64_t{Brick::words} * levels_.at_least[1].grid.brick_count) {
        if (is_first_thread()) f_.counts->changed[0] = f_.counts->changed[1] = f_.counts->changed[2] = 0;
        wait();
    }

    __device__ void wait() const { cooperative_groups::this_grid().sync(); }
    __device__ bool is_first_thread() const { return blockIdx.x == 0 && threadIdx.x == 0; }

    /// Raises the cells that raised(brick, w) gives for every word, all by the same state, by one level; returns
    /// whether there were any.
    template <class Raised>
    __device__ bool raise_words(const Raised& raised) {
        bool changed = false;
        GridLoop{}.each(words_, [&](std::uint32_t i) {
            const std::uint64_t cells = raised(levels_, i / Brick::words, static_cast<int>(i % Brick::words));
            if (cells != 0) f_.raised[i] = cells;
            changed |= cells != 0;
        });
        return apply(changed, [&](std::uint32_t block) { return f_.level[block] + 1; });
    }

    /// The same for the blocks of which raised(blocks, b) holds, to new_level(b).
    template <class Raised, class NewLevel>
    __device__ bool raise_blocks(const Raised& raised, const NewLevel& new_level) {
        const BlocksView blocks = f_.blocks();
        bool changed = false;
        GridLoop{}.each(blocks.count, [&](std::uint32_t b) {
            if (!raised(blocks, b)) return;
            changed = true;
            const int place = blocks.place[b];
            atomicOr(reinterpret_cast<Counter*>(
                         &f_.raised[std::uint64_t{Brick::words} * blocks.brick[b] + static_cast<unsigned>(place >> 6)]),
                     Counter{1} << (place & 63));
        });
        return apply(changed, new_level);
    }

    /// Balance and promotion, until nothing changes.
    __device__ void adjust_levels() {
        const auto unbalanced = [](const LevelSets& levels, std::uint32_t brick, int w) {
            return unbalanced_cells(levels, brick, w);
        };
        const auto promoted = [](const LevelSets& levels, std::uint32_t brick, int w) {
            return cells_to_promote(levels, brick, w);
        };
        do {
            while (raise_words(unbalanced)) {
            }
        } while (raise_words(promoted));
    }

private:
    template <class NewLevel>
    __device__ bool apply(bool changed, const NewLevel& new_level) {
        // Three flags in turn: one is being set, one may still be read, one is cleared for the next sweep.
        std::uint32_t* const flags = f_.counts->changed;
        if (changed) atomicOr(&flags[sweep_ % 3], 1U);
        if (is_first_thread()) flags[(sweep_ + 1) % 3] = 0;
        wait();
        const bool any = *const_cast<volatile std::uint32_t*>(&flags[sweep_ % 3]) != 0;
        ++sweep_;
        if (!any) return false;
        GridLoop{}.each(words_, [&](std::uint32_t i) {
            const std::uint64_t cells = f_.raised[i];
            if (cells == 0) return;
            f_.raised[i] = 0;
            raise_cells(levels_, f_.level, i / Brick::words, static_cast<int>(i % Brick::words), cells, new_level);
        });
        wait();
        return true;
    }

    const State& f_;
    LevelSets levels_;
    std::uint64_t words_;
    unsigned sweep_ = 0;
};

}  // namespace meniscus::cuda
