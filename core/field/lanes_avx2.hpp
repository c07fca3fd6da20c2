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
inline float reduce_min(Lanes<8> a) {
    __m128 v = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
    v = _mm_min_ps(v, _mm_movehl_ps(v, v));
    return _mm_cvtss_f32(_mm_min_ss(v, _mm_movehdup_ps(v)));
}

}  // namespace meniscus
