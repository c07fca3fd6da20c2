// Kinds of shuffles and atomic operations.
#pragma once

#include <cstdint>

namespace meniscus::benchmarks {

enum class PtxShuffle : std::uint8_t { index, up, down, exclusive_or };
enum class PtxAtomic : std::uint8_t { add, bit_or, bit_and, max, min, exchange, compare_and_swap, unknown };

}  // namespace meniscus::benchmarks
