// A cell as one bit of a set of cells, which many threads may change at once.
#pragma once

#include <cstdint>

#include "engine/cuda/state.hpp"

namespace meniscus::cuda {

struct CellBit {
    std::uint64_t word;  ///< index among the words of all bricks
    Counter bit;

    __device__ CellBit(const State& state, std::uint32_t block) {
        const unsigned place = state.place[block];
        word = std::uint64_t{Brick::words} * state.brick[block] + place / 64;
        bit = Counter{1} << place % 64;
    }
    /// Both return the word before the change.
    __device__ Counter put_into(std::uint64_t* set) const {
        return atomicOr(reinterpret_cast<Counter*>(&set[word]), bit);
    }
    __device__ Counter take_out_of(std::uint64_t* set) const {
        return atomicAnd(reinterpret_cast<Counter*>(&set[word]), ~bit);
    }
};

}  // namespace meniscus::cuda
