// Counting bits, on host and device.
#pragma once

#include <bit>
#include <cstdint>

#include "lattice/host_device.hpp"

#if (defined(__AVX2__) || defined(__BMI2__)) && !defined(__CUDACC__)
#include <immintrin.h>
#endif

namespace meniscus {

MENISCUS_HD inline int popcount(std::uint64_t bits) {
#ifdef __CUDA_ARCH__
    return __popcll(bits);
#else
    return std::popcount(bits);
#endif
}

/// Index of the highest bit that is set; bits != 0.
MENISCUS_HD inline int highest_bit(std::uint64_t bits) {
#ifdef __CUDA_ARCH__
    return 63 - __clzll(static_cast<long long>(bits));
#else
    return 63 - std::countl_zero(bits);
#endif
}

/// Index of the lowest bit that is set; bits != 0.
MENISCUS_HD inline int lowest_bit(std::uint64_t bits) {
#ifdef __CUDA_ARCH__
    return __ffsll(static_cast<long long>(bits)) - 1;
#else
    return std::countr_zero(bits);
#endif
}

/// Index of the n-th bit that is set, n from 0; there are more than n.
MENISCUS_HD inline int nth_bit(std::uint64_t bits, int n) {
    int place = 0;
    for (int width = 32; width > 0; width /= 2) {
        const int low = popcount(bits & ((std::uint64_t{1} << width) - 1));
        if (n < low) continue;
        n -= low;
        bits >>= width;
        place += width;
    }
    return place;
}

/// The bits of `word` at the places of `mask`, moved together.
MENISCUS_HD inline std::uint64_t gather_bits(std::uint64_t word, std::uint64_t mask) {
#if defined(__BMI2__) && !defined(__CUDACC__)
    return _pext_u64(word, mask);
#else
    std::uint64_t bits = 0;
    for (int i = 0; mask != 0; mask &= mask - 1, ++i) bits |= (word >> lowest_bit(mask) & 1) << i;
    return bits;
#endif
}

/// The reverse: the lowest bits of `bits` at the places of `mask`.
inline std::uint64_t scatter_bits(std::uint64_t bits, std::uint64_t mask) {
#if defined(__BMI2__) && !defined(__CUDACC__)
    return _pdep_u64(bits, mask);
#else
    std::uint64_t word = 0;
    for (; mask != 0; mask &= mask - 1, bits >>= 1) word |= (bits & 1) << lowest_bit(mask);
    return word;
#endif
}

/// Bit `place` of each of eight words, the first word's lowest.
MENISCUS_HD inline int bits_across(const std::uint64_t (&words)[8], int place) {
#if defined(__AVX2__) && !defined(__CUDACC__)
    const auto highest_bits = [&](int first) {
        const __m256i four = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + first));
        return _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_sll_epi64(four, _mm_cvtsi32_si128(63 - place))));
    };
    return highest_bits(0) | highest_bits(4) << 4;
#else
    int bits = 0;
    for (int i = 0; i < 8; ++i) bits |= static_cast<int>(words[i] >> place & 1) << i;
    return bits;
#endif
}

}  // namespace meniscus
