// Eight floats in a register of AVX2.
#pragma once

#include <immintrin.h>

#include "field/lanes_base.hpp"

namespace meniscus {

template <>
struct Lanes<8> {
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
inline Lanes<8> fma(Lanes<8> a, Lanes<8> b, Lanes<8> c) {
    return _mm256_fmadd_ps(a.v, b.v, c.v);
}
/// c - a b, rounded once.
inline Lanes<8> fnma(Lanes<8> a, Lanes<8> b, Lanes<8> c) {
    return _mm256_fnmadd_ps(a.v, b.v, c.v);
}
inline Lanes<8> sqrt(Lanes<8> a) {
    return _mm256_sqrt_ps(a.v);
}
inline Lanes<8> max(Lanes<8> a, Lanes<8> b) {
    return _mm256_max_ps(a.v, b.v);
}
inline Lanes<8> min(Lanes<8> a, Lanes<8> b) {
    return _mm256_min_ps(a.v, b.v);
}
inline Lanes<8> magnitude(Lanes<8> a) {
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v);
}
/// Rounded toward zero.
inline Lanes<8> trunc(Lanes<8> a) {
    return _mm256_round_ps(a.v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
/// The set of lanes in which a <= b.
inline unsigned less_equal(Lanes<8> a, Lanes<8> b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
/// Stores the lanes of a set one after the other; writes eight floats in all.
inline void compress_store(float* p, Lanes<8> a, unsigned set) {
    const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes_of_set[set].data()));
    _mm256_storeu_ps(p, _mm256_permutevar8x32_ps(a.v, order));
}
/// Adds to a row for each lane of a set the bits from `first` to `last`, whole numbers of 0 to 15.
inline void add_spans(std::uint16_t* rows, Lanes<8> first, Lanes<8> last, unsigned set) {
    const __m256i above = _mm256_sllv_epi32(_mm256_set1_epi32(2), _mm256_cvttps_epi32(last.v));
    const __m256i below = _mm256_sllv_epi32(_mm256_set1_epi32(1), _mm256_cvttps_epi32(first.v));
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i in_set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(set)), lane), lane);
    const __m256i spans = _mm256_and_si256(_mm256_sub_epi32(above, below), in_set);
    const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(spans), _mm256_extracti128_si256(spans, 1));
    auto* const all = reinterpret_cast<__m128i*>(rows);
    _mm_storeu_si128(all, _mm_or_si128(_mm_loadu_si128(all), words));
}
inline float reduce_min(Lanes<8> a) {
    __m128 v = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
    v = _mm_min_ps(v, _mm_movehl_ps(v, v));
    return _mm_cvtss_f32(_mm_min_ss(v, _mm_movehdup_ps(v)));
}

}  // namespace meniscus
