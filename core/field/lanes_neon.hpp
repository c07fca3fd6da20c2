// Eight floats in two registers of NEON (Arm, 64 bits).
#pragma once

#include <arm_neon.h>

#include "field/lanes_base.hpp"

namespace meniscus {

template <>
struct Lanes<8> {
    static constexpr int count = 8;
    float32x4_t low, high;
    Lanes() = default;
    Lanes(float32x4_t a, float32x4_t b) : low(a), high(b) {}
    Lanes(float value) : low(vdupq_n_f32(value)), high(low) {}
    static Lanes load(const float* p) { return {vld1q_f32(p), vld1q_f32(p + 4)}; }
    void store(float* p) const {
        vst1q_f32(p, low);
        vst1q_f32(p + 4, high);
    }
    friend Lanes operator+(Lanes a, Lanes b) { return {vaddq_f32(a.low, b.low), vaddq_f32(a.high, b.high)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {vsubq_f32(a.low, b.low), vsubq_f32(a.high, b.high)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {vmulq_f32(a.low, b.low), vmulq_f32(a.high, b.high)}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {vdivq_f32(a.low, b.low), vdivq_f32(a.high, b.high)}; }
};
inline Lanes<8> fma(Lanes<8> a, Lanes<8> b, Lanes<8> c) {
    return {vfmaq_f32(c.low, a.low, b.low), vfmaq_f32(c.high, a.high, b.high)};
}
/// c - a b, rounded once.
inline Lanes<8> fnma(Lanes<8> a, Lanes<8> b, Lanes<8> c) {
    return {vfmsq_f32(c.low, a.low, b.low), vfmsq_f32(c.high, a.high, b.high)};
}
inline Lanes<8> sqrt(Lanes<8> a) {
    return {vsqrtq_f32(a.low), vsqrtq_f32(a.high)};
}
// As scalars do: the second where the numbers are equal or one is none, which NEON's own instructions do otherwise.
inline Lanes<8> max(Lanes<8> a, Lanes<8> b) {
    return {vbslq_f32(vcgtq_f32(a.low, b.low), a.low, b.low), vbslq_f32(vcgtq_f32(a.high, b.high), a.high, b.high)};
}
inline Lanes<8> min(Lanes<8> a, Lanes<8> b) {
    return {vbslq_f32(vcltq_f32(a.low, b.low), a.low, b.low), vbslq_f32(vcltq_f32(a.high, b.high), a.high, b.high)};
}
/// Rounded toward zero.
inline Lanes<8> trunc(Lanes<8> a) {
    return {vrndq_f32(a.low), vrndq_f32(a.high)};
}
/// The set of lanes in which a <= b.
inline unsigned less_equal(Lanes<8> a, Lanes<8> b) {
    constexpr std::uint32_t bits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    const uint32x4_t low = vandq_u32(vcleq_f32(a.low, b.low), vld1q_u32(bits));
    const uint32x4_t high = vandq_u32(vcleq_f32(a.high, b.high), vld1q_u32(bits + 4));
    return vaddvq_u32(vorrq_u32(low, high));
}
/// Stores the lanes of a set one after the other; writes eight floats in all.
inline void compress_store(float* p, Lanes<8> a, unsigned set) {
    float values[8];
    a.store(values);
    for (std::size_t i = 0; i < 8; ++i) p[i] = values[lanes_of_set[set][i]];
}
/// Adds to a row for each lane of a set the bits from `first` to `last`, whole numbers of 0 to 15.
inline void add_spans(std::uint16_t* rows, Lanes<8> first, Lanes<8> last, unsigned set) {
    float from[8], to[8];
    first.store(from);
    last.store(to);
    for (std::size_t i = 0; i < 8; ++i)
        if ((set >> i & 1) != 0)
            rows[i] |= static_cast<std::uint16_t>((2U << static_cast<int>(to[i])) - (1U << static_cast<int>(from[i])));
}
inline float reduce_min(Lanes<8> a) {
    return vminvq_f32(vminq_f32(a.low, a.high));
}

}  // namespace meniscus
