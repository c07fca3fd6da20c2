// Eight floats on any processor.
#pragma once

#include <cmath>

#include "field/lanes_base.hpp"

namespace meniscus {

template <>
struct Lanes<8> {
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
inline Lanes<8> fma(const Lanes<8>& a, const Lanes<8>& b, const Lanes<8>& c) {
    return Lanes<8>::each([&](int i) { return std::fmaf(a.v[i], b.v[i], c.v[i]); });
}
inline Lanes<8> fnma(const Lanes<8>& a, const Lanes<8>& b, const Lanes<8>& c) {
    return Lanes<8>::each([&](int i) { return std::fmaf(-a.v[i], b.v[i], c.v[i]); });
}
inline Lanes<8> sqrt(const Lanes<8>& a) {
    return Lanes<8>::each([&](int i) { return std::sqrt(a.v[i]); });
}
inline Lanes<8> max(const Lanes<8>& a, const Lanes<8>& b) {
    return Lanes<8>::each([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline Lanes<8> min(const Lanes<8>& a, const Lanes<8>& b) {
    return Lanes<8>::each([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline Lanes<8> trunc(const Lanes<8>& a) {
    return Lanes<8>::each([&](int i) { return std::trunc(a.v[i]); });
}
inline unsigned less_equal(const Lanes<8>& a, const Lanes<8>& b) {
    unsigned set = 0;
    for (unsigned i = 0; i < Lanes<8>::count; ++i) set |= (a.v[i] <= b.v[i] ? 1U : 0U) << i;
    return set;
}
inline void compress_store(float* p, const Lanes<8>& a, unsigned set) {
    for (std::size_t i = 0; i < Lanes<8>::count; ++i) p[i] = a.v[lanes_of_set[set][i]];
}
inline void add_spans(std::uint16_t* rows, const Lanes<8>& first, const Lanes<8>& last, unsigned set) {
    for (std::size_t i = 0; i < Lanes<8>::count; ++i)
        if ((set >> i & 1) != 0)
            rows[i] |=
                static_cast<std::uint16_t>((2U << static_cast<int>(last.v[i])) - (1U << static_cast<int>(first.v[i])));
}
inline float reduce_min(const Lanes<8>& a) {
    float result = a.v[0];
    for (const float x : a.v) result = x < result ? x : result;
    return result;
}

}  // namespace meniscus
