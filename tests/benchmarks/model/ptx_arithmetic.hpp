// PTX's arithmetic, lane by lane. Rounding is the host's, which is that of PTX for all operations here.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "model/ptx_module.hpp"

namespace meniscus::benchmarks::ptx_arithmetic {

using s16 = std::int16_t;
using s32 = std::int32_t;
using s64 = std::int64_t;
using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;

template <std::size_t bytes>
using Bits =
    std::conditional_t<bytes == 1, u8, std::conditional_t<bytes == 2, u16, std::conditional_t<bytes == 4, u32, u64>>>;

template <class T>
T get(u64 bits) {
    return std::bit_cast<T>(static_cast<Bits<sizeof(T)>>(bits));
}
template <class T>
u64 put(T value) {
    if constexpr (std::is_same_v<T, bool>)
        return value ? 1 : 0;
    else
        return std::bit_cast<Bits<sizeof(T)>>(value);
}

/// Calls compute(lane) and stores what it returns, in the lanes of the mask.
template <class Compute>
void each_lane(const PtxInstruction& i, PtxLanes* slots, u32 mask, const Compute& compute) {
    u64* const to = slots[i.to[0]].of;
    if (mask == ~0U) {
        for (int lane = 0; lane < 32; ++lane) to[lane] = compute(lane);
    } else {
        for (u32 left = mask; left != 0; left &= left - 1) {
            const int lane = std::countr_zero(left);
            to[lane] = compute(lane);
        }
    }
}

template <class T, auto F>
void one(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask, [&](int l) { return put(F(get<T>(a[l]))); });
}
template <class T, auto F>
void two(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    each_lane(i, slots, mask, [&](int l) { return put(F(get<T>(a[l]), get<T>(b[l]))); });
}
template <class T, auto F>
void three(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = slots[i.from[2]].of;
    each_lane(i, slots, mask, [&](int l) { return put(F(get<T>(a[l]), get<T>(b[l]), get<T>(c[l]))); });
}

template <class T>
using Unsigned = Bits<sizeof(T)>;

// Sums and products of integers wrap around; 16 bits are computed with 32.
template <class T>
constexpr auto plus = [](T a, T b) { return static_cast<T>(a + b); };
template <class T>
constexpr auto minus = [](T a, T b) { return static_cast<T>(a - b); };
template <class T>
constexpr auto times = [](T a, T b) { return static_cast<T>(static_cast<std::common_type_t<T, u32>>(a) * b); };
template <class T>
constexpr auto divided = [](T a, T b) {
    if constexpr (std::is_integral_v<T>)
        return b == 0 ? std::numeric_limits<T>::max() : static_cast<T>(a / b);
    else
        return a / b;
};
template <class T>
constexpr auto remainder_of = [](T a, T b) { return b == 0 ? a : static_cast<T>(a % b); };
template <class T>
constexpr auto times_plus = [](T a, T b, T c) { return static_cast<T>(a * b + c); };
template <class T>
constexpr auto fused = [](T a, T b, T c) { return std::fma(a, b, c); };
template <class T>
constexpr auto greater_of = [](T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (a == b) return std::signbit(a) ? b : a;
        return std::fmax(a, b);
    } else {
        return a > b ? a : b;
    }
};
template <class T>
constexpr auto less_of = [](T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (a == b) return std::signbit(a) ? a : b;
        return std::fmin(a, b);
    } else {
        return a < b ? a : b;
    }
};
template <class T>
constexpr auto negated = [](T a) {
    if constexpr (std::is_integral_v<T>)
        return static_cast<T>(~static_cast<Unsigned<T>>(a) + 1U);
    else
        return -a;
};
template <class T>
constexpr auto absolute = [](T a) {
    if constexpr (std::is_integral_v<T>)
        return a < 0 ? negated<T>(a) : a;
    else
        return std::fabs(a);
};
template <class T>
constexpr auto root = [](T a) { return std::sqrt(a); };
template <class T>
constexpr auto reciprocal = [](T a) { return T{1} / a; };
template <class T>
constexpr auto bits_and = [](T a, T b) { return static_cast<T>(a & b); };
template <class T>
constexpr auto bits_or = [](T a, T b) { return static_cast<T>(a | b); };
template <class T>
constexpr auto bits_xor = [](T a, T b) { return static_cast<T>(a ^ b); };
template <class T>
constexpr auto bits_not = [](T a) { return static_cast<T>(~a); };
template <class T>
constexpr auto popcount_of = [](T a) { return static_cast<u32>(std::popcount(a)); };
template <class T>
constexpr auto zeros_above = [](T a) { return static_cast<u32>(std::countl_zero(a)); };
template <class T>
constexpr auto reversed = [](T a) {
    T out = 0;
    for (unsigned bit = 0; bit < 8 * sizeof(T); ++bit) out = static_cast<T>(out << 1 | (a >> bit & 1));
    return out;
};
/// The place of the highest bit that differs from the sign, all ones without any.
template <class T>
constexpr auto highest = [](T a) {
    auto bits = static_cast<Unsigned<T>>(a);
    if (std::is_signed_v<T> && a < 0) bits = static_cast<Unsigned<T>>(~bits);
    return bits == 0 ? ~0U : static_cast<u32>(8 * sizeof(T) - 1 - static_cast<unsigned>(std::countl_zero(bits)));
};
template <class T>
constexpr auto high_product = [](T a, T b) {
    __extension__ using Wide = std::conditional_t<sizeof(T) == 4, std::conditional_t<std::is_signed_v<T>, s64, u64>,
                                                  std::conditional_t<std::is_signed_v<T>, __int128, unsigned __int128>>;
    return static_cast<T>(static_cast<Wide>(a) * static_cast<Wide>(b) >> (8 * sizeof(T)));
};
template <class T>
constexpr auto is_equal = [](T a, T b) { return a == b; };
template <class T>
constexpr auto is_other = [](T a, T b) {  // ordered: false for no number
    if constexpr (std::is_floating_point_v<T>)
        return a < b || a > b;
    else
        return a != b;
};
template <class T>
constexpr auto is_less = [](T a, T b) { return a < b; };
template <class T>
constexpr auto is_at_most = [](T a, T b) { return a <= b; };
template <class T>
constexpr auto is_greater = [](T a, T b) { return a > b; };
template <class T>
constexpr auto is_at_least = [](T a, T b) { return a >= b; };
template <class T>
constexpr auto is_unordered = [](T a, T b) { return std::isnan(a) || std::isnan(b); };
template <auto Ordered, class T>
constexpr auto or_unordered = [](T a, T b) { return std::isnan(a) || std::isnan(b) || Ordered(a, b); };

/// Shifts beyond the width give 0, or the sign.
template <class T>
void shift_left(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    each_lane(i, slots, mask, [&](int l) {
        const u32 by = static_cast<u32>(b[l]);
        return by >= 8 * sizeof(T) ? 0 : put(static_cast<T>(get<T>(a[l]) << by));
    });
}
template <class T>
void shift_right(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    each_lane(i, slots, mask, [&](int l) {
        u32 by = static_cast<u32>(b[l]);
        if (by >= 8 * sizeof(T)) {
            if (std::is_unsigned_v<T>) return u64{0};
            by = 8 * sizeof(T) - 1;
        }
        return put(static_cast<T>(get<T>(a[l]) >> by));
    });
}
template <bool left>
void funnel_shift(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const low = slots[i.from[0]].of;
    const u64* const high = slots[i.from[1]].of;
    const u64* const by = slots[i.from[2]].of;
    const bool clamps = i.opcode.find(".clamp") != std::string::npos;
    each_lane(i, slots, mask, [&](int l) {
        const u64 both = high[l] << 32 | (low[l] & ~0U);
        const auto asked = static_cast<u32>(by[l]);
        const u32 n = clamps ? (asked < 32 ? asked : 32) : asked % 32;
        return u64{static_cast<u32>(left ? both << n >> 32 : both >> n)};
    });
}

template <class T, class Wide, bool adds>
void wide_product(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = adds ? slots[i.from[2]].of : a;
    each_lane(i, slots, mask, [&](int l) {
        auto product = static_cast<Unsigned<Wide>>(static_cast<Wide>(get<T>(a[l])) * static_cast<Wide>(get<T>(b[l])));
        if (adds) product = static_cast<Unsigned<Wide>>(product + get<Unsigned<Wide>>(c[l]));
        return put(product);
    });
}

template <class T>
void select(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const p = slots[i.from[2]].of;
    each_lane(i, slots, mask, [&](int l) { return put(get<T>(p[l] != 0 ? a[l] : b[l])); });
}

template <class T>
void move(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask, [&](int l) { return put(get<T>(a[l])); });
}
template <class From, class To>
void extend(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask, [&](int l) { return put(static_cast<To>(get<From>(a[l]))); });
}
/// Packs a vector's parts into one value, the lowest first.
template <class Part>
void pack(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    each_lane(i, slots, mask, [&](int l) {
        u64 all = 0;
        for (unsigned k = 0; k < i.elements; ++k)
            all |= put(get<Part>(slots[i.from[k]].of[l])) << (8 * sizeof(Part) * k);
        return all;
    });
}
template <class Part>
void unpack(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const PtxLanes all = slots[i.from[0]];
    for (unsigned k = 0; k < i.elements; ++k)
        for (int l = 0; l < 32; ++l)
            if ((mask >> l & 1) != 0)
                slots[i.to[k]].of[l] = put(static_cast<Part>(all.of[l] >> (8 * sizeof(Part) * k)));
}

enum class Rounding { none, nearest, to_zero, down, up };

template <Rounding how>
double rounded(double a) {
    switch (how) {
        case Rounding::none:
            return a;
        case Rounding::nearest:
            return std::nearbyint(a);
        case Rounding::to_zero:
            return std::trunc(a);
        case Rounding::down:
            return std::floor(a);
        case Rounding::up:
            return std::ceil(a);
    }
    return a;
}
/// To an integer: what does not fit becomes the nearest that does; no number becomes 0, or in 64 bits the highest bit.
template <class From, class To, Rounding how>
void round_to_integer(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask, [&](int l) {
        const double value = rounded<how>(static_cast<double>(get<From>(a[l])));
        if (std::isnan(value)) return sizeof(To) == 8 ? u64{1} << 63 : u64{0};
        if (value <= static_cast<double>(std::numeric_limits<To>::min())) return put(std::numeric_limits<To>::min());
        if (value >= static_cast<double>(std::numeric_limits<To>::max())) return put(std::numeric_limits<To>::max());
        return put(static_cast<To>(value));
    });
}
template <class T, Rounding how>
void round_in_place(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask,
              [&](int l) { return put(static_cast<T>(rounded<how>(static_cast<double>(get<T>(a[l]))))); });
}

/// Bytes of both words by a selector of four hexadecimal digits.
inline void permute(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = slots[i.from[2]].of;
    each_lane(i, slots, mask, [&](int l) {
        const u64 both = (b[l] & ~0U) << 32 | (a[l] & ~0U);
        u64 out = 0;
        for (unsigned k = 0; k < 4; ++k) {
            const u64 choice = c[l] >> (4 * k) & 15;
            u64 byte = both >> (8 * (choice & 7)) & 0xFF;
            if ((choice & 8) != 0) byte = (byte & 0x80) != 0 ? 0xFF : 0;
            out |= byte << (8 * k);
        }
        return out;
    });
}
template <class T>
void insert_bits(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = slots[i.from[2]].of;
    const u64* const d = slots[i.from[3]].of;
    each_lane(i, slots, mask, [&](int l) {
        const u64 at = c[l] & 0xFF;
        const u64 n = d[l] & 0xFF;
        if (at >= 8 * sizeof(T) || n == 0) return put(get<T>(b[l]));
        const u64 field = n >= 64 ? ~u64{0} : (u64{1} << n) - 1;
        return put(static_cast<T>((b[l] & ~(field << at)) | (a[l] & field) << at));
    });
}
template <class T>
void extract_bits(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = slots[i.from[2]].of;
    constexpr unsigned width = 8 * sizeof(T);
    each_lane(i, slots, mask, [&](int l) {
        const unsigned at = static_cast<unsigned>(b[l] & 0xFF);
        const unsigned n = static_cast<unsigned>(c[l] & 0xFF);
        if (n == 0) return u64{0};
        const unsigned last = at + n - 1 < width - 1 ? at + n - 1 : width - 1;
        const bool sign = std::is_signed_v<T> && (a[l] >> last & 1) != 0;
        u64 out = 0;
        for (unsigned bit = 0; bit < width; ++bit) {
            const bool is_set = bit < n && at + bit < width ? (a[l] >> (at + bit) & 1) != 0 : sign;
            out |= u64{is_set} << bit;
        }
        return out;
    });
}
/// Two 16-bit numbers of a by two bytes of b, plus c.
template <class A, class B, bool high>
void dot_two(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = slots[i.from[2]].of;
    each_lane(i, slots, mask, [&](int l) {
        u64 sum = c[l];
        for (unsigned k = 0; k < 2; ++k)
            sum += static_cast<u64>(static_cast<s64>(static_cast<A>(a[l] >> (16 * k))) *
                                    static_cast<s64>(static_cast<B>(b[l] >> (8 * (k + (high ? 2 : 0))))));
        return u64{static_cast<u32>(sum)};
    });
}
inline void lookup(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    const u64* const b = slots[i.from[1]].of;
    const u64* const c = slots[i.from[2]].of;
    const u64* const table = slots[i.from[3]].of;
    each_lane(i, slots, mask, [&](int l) {
        u64 out = 0;
        for (unsigned k = 0; k < 8; ++k)
            if ((table[l] >> k & 1) != 0)
                out |= ((k & 4) != 0 ? a[l] : ~a[l]) & ((k & 2) != 0 ? b[l] : ~b[l]) & ((k & 1) != 0 ? c[l] : ~c[l]);
        return out & ~0U;
    });
}
inline void truth_not(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask, [&](int l) { return u64{a[l] == 0}; });
}

}  // namespace meniscus::benchmarks::ptx_arithmetic
