// Eight floats that are computed with at once. Every operation rounds as the scalar one does, so that a body written
// for a type F gives the same bits with F = float (a midpoint, a CUDA thread) and F = Lanes (a block of samples).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lattice/host_device.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace meniscus {

#ifndef __CUDACC__

/// For every set of eight lanes, the lanes that are in it, ascending, then any.
inline constexpr auto lanes_of_set = [] {
    std::array<std::array<std::int32_t, 8>, 256> table{};
    for (std::size_t set = 0; set < 256; ++set) {
        std::size_t count = 0;
        for (std::int32_t lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1) != 0) table[set][count++] = lane;
    }
    return table;
}();

#if defined(__AVX2__) && defined(__FMA__)

struct Lanes {
    static constexpr int count = 8;
    __m256 v;
    Lanes() = default;
    Lanes(__m256 value) : v(value) {}
    Lanes(float value) : v(_mm256_set1_ps(value)) {}
    static Lanes load(const float* p) { return _mm256_loadu_ps(p); }
    void store(float* p) const { _mm256_storeu_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return _mm256_add_ps(a.v, b.v); }
    friend Lanes operator-(Lanes a, Lanes b) { return _mm256_sub_ps(a.v, b.v); }
    friend Lanes operator*(Lanes a, Lanes b) { return _mm256_mul_ps(a.v, b.v); }
    friend Lanes operator/(Lanes a, Lanes b) { return _mm256_div_ps(a.v, b.v); }
};
inline Lanes fma(Lanes a, Lanes b, Lanes c) {
    return _mm256_fmadd_ps(a.v, b.v, c.v);
}
/// c - a b, rounded once.
inline Lanes fnma(Lanes a, Lanes b, Lanes c) {
    return _mm256_fnmadd_ps(a.v, b.v, c.v);
}
inline Lanes sqrt(Lanes a) {
    return _mm256_sqrt_ps(a.v);
}
inline Lanes max(Lanes a, Lanes b) {
    return _mm256_max_ps(a.v, b.v);
}
inline Lanes min(Lanes a, Lanes b) {
    return _mm256_min_ps(a.v, b.v);
}
/// Rounded toward zero.
inline Lanes trunc(Lanes a) {
    return _mm256_round_ps(a.v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
/// The set of lanes in which a <= b.
inline unsigned less_equal(Lanes a, Lanes b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
/// Stores the lanes of a set one after the other; writes eight floats in all.
inline void compress_store(float* p, Lanes a, unsigned set) {
    const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes_of_set[set].data()));
    _mm256_storeu_ps(p, _mm256_permutevar8x32_ps(a.v, order));
}
inline float reduce_min(Lanes a) {
    __m128 v = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
    v = _mm_min_ps(v, _mm_movehl_ps(v, v));
    return _mm_cvtss_f32(_mm_min_ss(v, _mm_movehdup_ps(v)));
}

#else

struct Lanes {
    static constexpr int count = 8;
    float v[count];
    Lanes() = default;
    Lanes(float value) {
        for (float& x : v) x = value;
    }
    static Lanes load(const float* p) {
        Lanes r;
        for (int i = 0; i < count; ++i) r.v[i] = p[i];
        return r;
    }
    void store(float* p) const {
        for (int i = 0; i < count; ++i) p[i] = v[i];
    }
    template <class Operation>
    static Lanes each(Operation operation) {
        Lanes r;
        for (int i = 0; i < count; ++i) r.v[i] = operation(i);
        return r;
    }
    friend Lanes operator+(const Lanes& a, const Lanes& b) {
        return each([&](int i) { return a.v[i] + b.v[i]; });
    }
    friend Lanes operator-(const Lanes& a, const Lanes& b) {
        return each([&](int i) { return a.v[i] - b.v[i]; });
    }
    friend Lanes operator*(const Lanes& a, const Lanes& b) {
        return each([&](int i) { return a.v[i] * b.v[i]; });
    }
    friend Lanes operator/(const Lanes& a, const Lanes& b) {
        return each([&](int i) { return a.v[i] / b.v[i]; });
    }
};
inline Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
    return Lanes::each([&](int i) { return std::fmaf(a.v[i], b.v[i], c.v[i]); });
}
inline Lanes fnma(const Lanes& a, const Lanes& b, const Lanes& c) {
    return Lanes::each([&](int i) { return std::fmaf(-a.v[i], b.v[i], c.v[i]); });
}
inline Lanes sqrt(const Lanes& a) {
    return Lanes::each([&](int i) { return std::sqrt(a.v[i]); });
}
inline Lanes max(const Lanes& a, const Lanes& b) {
    return Lanes::each([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline Lanes min(const Lanes& a, const Lanes& b) {
    return Lanes::each([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline Lanes trunc(const Lanes& a) {
    return Lanes::each([&](int i) { return std::trunc(a.v[i]); });
}
inline unsigned less_equal(const Lanes& a, const Lanes& b) {
    unsigned set = 0;
    for (unsigned i = 0; i < Lanes::count; ++i) set |= (a.v[i] <= b.v[i] ? 1U : 0U) << i;
    return set;
}
inline void compress_store(float* p, const Lanes& a, unsigned set) {
    for (std::size_t i = 0; i < Lanes::count; ++i) p[i] = a.v[lanes_of_set[set][i]];
}
inline float reduce_min(const Lanes& a) {
    float result = a.v[0];
    for (const float x : a.v) result = x < result ? x : result;
    return result;
}

#endif

inline float reduce_max(Lanes a) {
    return -reduce_min(Lanes(0.0F) - a);
}

#endif

MENISCUS_HD inline float fma(float a, float b, float c) {
#ifdef __CUDA_ARCH__
    return fmaf(a, b, c);
#else
    return __builtin_fmaf(a, b, c);
#endif
}
MENISCUS_HD inline float fnma(float a, float b, float c) {
    return fma(-a, b, c);
}
MENISCUS_HD inline float sqrt(float a) {
#ifdef __CUDA_ARCH__
    return sqrtf(a);
#else
    return __builtin_sqrtf(a);
#endif
}
MENISCUS_HD inline float trunc(float a) {
#ifdef __CUDA_ARCH__
    return truncf(a);
#else
    return __builtin_truncf(a);
#endif
}
MENISCUS_HD inline float max(float a, float b) {
    return a > b ? a : b;
}
MENISCUS_HD inline float min(float a, float b) {
    return a < b ? a : b;
}

}  // namespace meniscus
