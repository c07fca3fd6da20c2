// Sixteen floats in a register of AVX-512.
#pragma once

#include <immintrin.h>

#include "field/lanes_base.hpp"

namespace meniscus {

template <>
struct Lanes<16> {
    static constexpr int count = 16;
    __m512 v;
    Lanes() = default;
    Lanes(__m512 value) : v(value) {}
    Lanes(float value) : v(_mm512_set1_ps(value)) {}
    static Lanes load(const float* p) { return _mm512_loadu_ps(p); }
    void store(float* p) const { _mm512_storeu_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return _mm512_add_ps(a.v, b.v); }
    friend Lanes operator-(Lanes a, Lanes b) { return _mm512_sub_ps(a.v, b.v); }
    friend Lanes operator*(Lanes a, Lanes b) { return _mm512_mul_ps(a.v, b.v); }
    friend Lanes operator/(Lanes a, Lanes b) { return _mm512_div_ps(a.v, b.v); }
};
inline Lanes<16> fma(Lanes<16> a, Lanes<16> b, Lanes<16> c) {
    return _mm512_fmadd_ps(a.v, b.v, c.v);
}
/// c - a b, rounded once.
inline Lanes<16> fnma(Lanes<16> a, Lanes<16> b, Lanes<16> c) {
    return _mm512_fnmadd_ps(a.v, b.v, c.v);
}
inline Lanes<16> sqrt(Lanes<16> a) {
    return _mm512_sqrt_ps(a.v);
}
inline Lanes<16> max(Lanes<16> a, Lanes<16> b) {
    return _mm512_max_ps(a.v, b.v);
}
inline Lanes<16> min(Lanes<16> a, Lanes<16> b) {
    return _mm512_min_ps(a.v, b.v);
}
inline Lanes<16> magnitude(Lanes<16> a) {
    return _mm512_abs_ps(a.v);
}
/// Rounded toward zero.
inline Lanes<16> trunc(Lanes<16> a) {
    return _mm512_roundscale_ps(a.v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
/// The set of lanes in which a <= b.
inline unsigned less_equal(Lanes<16> a, Lanes<16> b) {
    return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ);
}
/// Stores the lanes of a set one after the other; writes sixteen floats in all.
inline void compress_store(float* p, Lanes<16> a, unsigned set) {
    _mm512_storeu_ps(p, _mm512_maskz_compress_ps(static_cast<__mmask16>(set), a.v));
}
/// Adds to a row for each lane of a set the bits from `first` to `last`, whole numbers of 0 to 15.
inline void add_spans(std::uint16_t* rows, Lanes<16> first, Lanes<16> last, unsigned set) {
    const __m512i above = _mm512_sllv_epi32(_mm512_set1_epi32(2), _mm512_cvttps_epi32(last.v));
    const __m512i below = _mm512_sllv_epi32(_mm512_set1_epi32(1), _mm512_cvttps_epi32(first.v));
    const __m512i spans = _mm512_maskz_sub_epi32(static_cast<__mmask16>(set), above, below);
    auto* const all = reinterpret_cast<__m256i*>(rows);
    _mm256_storeu_si256(all, _mm256_or_si256(_mm256_loadu_si256(all), _mm512_cvtepi32_epi16(spans)));
}
inline float reduce_min(Lanes<16> a) {
    return _mm512_reduce_min_ps(a.v);
}

}  // namespace meniscus
