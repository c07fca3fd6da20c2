// Floats that are computed with at once. Every operation rounds as the scalar one does, so that a body written for a
// type F gives the same bits with F = float (a midpoint, a CUDA thread) and F = Lanes<N> (samples in a row).
#pragma once

#include "lattice/host_device.hpp"

#ifndef __CUDACC__
#if defined(__AVX2__) && defined(__FMA__)
#include "field/lanes_avx2.hpp"
#elif defined(MENISCUS_NEON)
#include "field/lanes_neon.hpp"
#else
#include "field/lanes_portable.hpp"
#endif
#if defined(__AVX512F__)
#include "field/lanes_avx512.hpp"
#endif
#endif

namespace meniscus {

#ifndef __CUDACC__

/// As many floats as a register holds. Their number is a matter of speed alone.
#if defined(__AVX512F__)
using WideLanes = Lanes<16>;
#else
using WideLanes = Lanes<8>;
#endif
/// For few floats, which would not fill half of a wider register: that costs up to twice as much.
using NarrowLanes = Lanes<8>;

/// Calls visit.operator()<F>() with the narrower of the two that has at least `floats` lanes.
template <class Visit>
void with_lanes_for(int floats, const Visit& visit) {
    if (floats <= NarrowLanes::count) return visit.template operator()<NarrowLanes>();
    visit.template operator()<WideLanes>();
}

template <int N>
float reduce_max(Lanes<N> a) {
    return -reduce_min(Lanes<N>(0.0F) - a);
}
template <int N>
Lanes<N> magnitude(Lanes<N> a) {
    return max(a, Lanes<N>(0.0F) - a);
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
MENISCUS_HD inline float magnitude(float a) {
#ifdef __CUDA_ARCH__
    return fabsf(a);
#else
    return __builtin_fabsf(a);
#endif
}
/// The set of one lane, or none.
MENISCUS_HD inline unsigned less_equal(float a, float b) {
    return a <= b ? 1 : 0;
}
MENISCUS_HD inline float max(float a, float b) {
    return a > b ? a : b;
}
MENISCUS_HD inline float min(float a, float b) {
    return a < b ? a : b;
}

}  // namespace meniscus
