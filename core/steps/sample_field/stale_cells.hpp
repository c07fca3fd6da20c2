// The cells around those that were raised since the band began to settle: only there can rules find something new.
#pragma once

#include <cstdint>

#include "engine/cuda/cell_bit.hpp"
#include "engine/cuda/state.hpp"

namespace meniscus::cuda {

/// Lists that grow while some are raised, and are read after a wait. Cells stay on them: few are raised, and a test
/// more than needed does no harm.
class StaleCells {
public:
    static constexpr bool follows_raising = true;

    __device__ explicit StaleCells(const State& state) : state_(state) {}

    __device__ std::uint32_t count() const { return static_cast<volatile std::uint32_t&>(state_.counts->stale_cells); }
    __device__ std::uint32_t operator[](std::uint64_t i) const { return state_.stale_cells()[i]; }
    /// The words of bricks that hold stale cells.
    __device__ std::uint64_t words() const { return static_cast<volatile std::uint32_t&>(state_.counts->stale_words); }
    __device__ std::uint32_t word(std::uint64_t i) const { return state_.stale_words()[i]; }

    __device__ void mark(std::uint32_t block) const {
        const CellBit cell(state_, block);
        const Counter before = cell.put_into(state_.is_stale());
        if ((before & cell.bit) != 0) return;
        state_.stale_cells()[atomicAdd(&state_.counts->stale_cells, 1U)] = block;
        if (before == 0)
            state_.stale_words()[atomicAdd(&state_.counts->stale_words, 1U)] = static_cast<std::uint32_t>(cell.word);
    }

private:
    const State& state_;
};

}  // namespace meniscus::cuda
