// What PTX's arithmetic computes, by opcode. Rounding is the host's, which is that of PTX for all that is used here.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <unordered_map>

#include "model/ptx_module.hpp"

namespace meniscus::benchmarks {
namespace {

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
/// Of a vector's parts, the lowest first.
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
void permute(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
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
void lookup(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
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
void truth_not(const PtxInstruction& i, PtxLanes* slots, u32 mask) {
    const u64* const a = slots[i.from[0]].of;
    each_lane(i, slots, mask, [&](int l) { return u64{a[l] == 0}; });
}

using Table = std::unordered_map<std::string, PtxCompute>;

template <class T>
void add_integer(Table& t, const std::string& type) {
    t["add." + type] = two<Unsigned<T>, plus<Unsigned<T>>>;
    t["sub." + type] = two<Unsigned<T>, minus<Unsigned<T>>>;
    t["mul.lo." + type] = two<Unsigned<T>, times<Unsigned<T>>>;
    t["div." + type] = two<T, divided<T>>;
    t["rem." + type] = two<T, remainder_of<T>>;
    t["min." + type] = two<T, less_of<T>>;
    t["max." + type] = two<T, greater_of<T>>;
    t["neg." + type] = one<T, negated<T>>;
    t["abs." + type] = one<T, absolute<T>>;
    t["shr." + type] = shift_right<T>;
    t["setp.eq." + type] = two<T, is_equal<T>>;
    t["setp.ne." + type] = two<T, is_other<T>>;
    t["setp.lt." + type] = t["setp.lo." + type] = two<T, is_less<T>>;
    t["setp.le." + type] = t["setp.ls." + type] = two<T, is_at_most<T>>;
    t["setp.gt." + type] = t["setp.hi." + type] = two<T, is_greater<T>>;
    t["setp.ge." + type] = t["setp.hs." + type] = two<T, is_at_least<T>>;
    t["bfind." + type] = one<T, highest<T>>;
    t["selp." + type] = select<T>;
    t["mov." + type] = move<T>;
    if constexpr (sizeof(T) >= 4) {
        t["mad.lo." + type] = three<Unsigned<T>, times_plus<Unsigned<T>>>;
        t["mul.hi." + type] = two<T, high_product<T>>;
        t["bfe." + type] = extract_bits<T>;
    }
}
template <class T>
void add_bits(Table& t, const std::string& type) {
    t["and." + type] = two<T, bits_and<T>>;
    t["or." + type] = two<T, bits_or<T>>;
    t["xor." + type] = two<T, bits_xor<T>>;
    t["not." + type] = one<T, bits_not<T>>;
    t["shl." + type] = shift_left<T>;
    t["shr." + type] = shift_right<T>;
    t["popc." + type] = one<T, popcount_of<T>>;
    t["clz." + type] = one<T, zeros_above<T>>;
    t["brev." + type] = one<T, reversed<T>>;
    t["bfi." + type] = insert_bits<T>;
    t["selp." + type] = select<T>;
    t["mov." + type] = move<T>;
    t["setp.eq." + type] = two<T, is_equal<T>>;
    t["setp.ne." + type] = two<T, is_other<T>>;
}
template <class T>
void add_float(Table& t, const std::string& type) {
    t["add.rn." + type] = t["add." + type] = two<T, plus<T>>;
    t["sub.rn." + type] = t["sub." + type] = two<T, minus<T>>;
    t["mul.rn." + type] = t["mul." + type] = two<T, [](T a, T b) { return a * b; }>;
    t["div.rn." + type] = two<T, divided<T>>;
    t["fma.rn." + type] = three<T, fused<T>>;
    t["sqrt.rn." + type] = one<T, root<T>>;
    t["rcp.rn." + type] = one<T, reciprocal<T>>;
    t["neg." + type] = one<T, negated<T>>;
    t["abs." + type] = one<T, absolute<T>>;
    t["max." + type] = two<T, greater_of<T>>;
    t["min." + type] = two<T, less_of<T>>;
    t["mov." + type] = move<T>;
    t["selp." + type] = select<T>;
    t["setp.eq." + type] = two<T, is_equal<T>>;
    t["setp.ne." + type] = two<T, is_other<T>>;
    t["setp.lt." + type] = two<T, is_less<T>>;
    t["setp.le." + type] = two<T, is_at_most<T>>;
    t["setp.gt." + type] = two<T, is_greater<T>>;
    t["setp.ge." + type] = two<T, is_at_least<T>>;
    t["setp.nan." + type] = two<T, is_unordered<T>>;
    t["setp.equ." + type] = two<T, or_unordered<is_equal<T>, T>>;
    t["setp.neu." + type] = two<T, or_unordered<is_other<T>, T>>;
    t["setp.ltu." + type] = two<T, or_unordered<is_less<T>, T>>;
    t["setp.leu." + type] = two<T, or_unordered<is_at_most<T>, T>>;
    t["setp.gtu." + type] = two<T, or_unordered<is_greater<T>, T>>;
    t["setp.geu." + type] = two<T, or_unordered<is_at_least<T>, T>>;
    t["cvt.rni." + type + "." + type] = round_in_place<T, Rounding::nearest>;
    t["cvt.rzi." + type + "." + type] = round_in_place<T, Rounding::to_zero>;
    t["cvt.rmi." + type + "." + type] = round_in_place<T, Rounding::down>;
    t["cvt.rpi." + type + "." + type] = round_in_place<T, Rounding::up>;
}
template <class F>
void add_from_float(Table& t, const std::string& from) {
    const auto add = [&]<class To>(const std::string& to, To) {
        t["cvt.rni." + to + "." + from] = round_to_integer<F, To, Rounding::nearest>;
        t["cvt.rzi." + to + "." + from] = round_to_integer<F, To, Rounding::to_zero>;
        t["cvt.rmi." + to + "." + from] = round_to_integer<F, To, Rounding::down>;
        t["cvt.rpi." + to + "." + from] = round_to_integer<F, To, Rounding::up>;
    };
    add("s16", s16{});
    add("u16", u16{});
    add("s32", s32{});
    add("u32", u32{});
    add("s64", s64{});
    add("u64", u64{});
}
template <class From>
void add_from_integer(Table& t, const std::string& from) {
    t["cvt.u8." + from] = extend<From, u8>;
    t["cvt.s8." + from] = extend<From, std::int8_t>;
    t["cvt.u16." + from] = extend<From, u16>;
    t["cvt.s16." + from] = extend<From, s16>;
    t["cvt.u32." + from] = extend<From, u32>;
    t["cvt.s32." + from] = extend<From, s32>;
    t["cvt.u64." + from] = extend<From, u64>;
    t["cvt.s64." + from] = extend<From, s64>;
    t["cvt.rn.f32." + from] = extend<From, float>;
    t["cvt.rn.f64." + from] = extend<From, double>;
}

Table make_table() {
    Table t;
    add_integer<s16>(t, "s16");
    add_integer<u16>(t, "u16");
    add_integer<s32>(t, "s32");
    add_integer<u32>(t, "u32");
    add_integer<s64>(t, "s64");
    add_integer<u64>(t, "u64");
    add_bits<u16>(t, "b16");
    add_bits<u32>(t, "b32");
    add_bits<u64>(t, "b64");
    add_float<float>(t, "f32");
    add_float<double>(t, "f64");
    add_from_float<float>(t, "f32");
    add_from_float<double>(t, "f64");
    add_from_integer<std::int8_t>(t, "s8");
    add_from_integer<u8>(t, "u8");
    add_from_integer<s16>(t, "s16");
    add_from_integer<u16>(t, "u16");
    add_from_integer<s32>(t, "s32");
    add_from_integer<u32>(t, "u32");
    add_from_integer<s64>(t, "s64");
    add_from_integer<u64>(t, "u64");
    // The host's, which are closer: nothing that asks for an estimate leaves it at that.
    t["lg2.approx.ftz.f32"] = t["lg2.approx.f32"] = one<float, [](float a) { return std::log2(a); }>;
    t["ex2.approx.ftz.f32"] = t["ex2.approx.f32"] = one<float, [](float a) { return std::exp2(a); }>;
    t["rcp.approx.ftz.f64"] = one<double, reciprocal<double>>;
    t["copysign.f64"] = two<double, [](double sign, double of) { return std::copysign(of, sign); }>;
    t["cvt.f64.f32"] = extend<float, double>;
    t["cvt.rn.f32.f64"] = extend<double, float>;
    t["and.pred"] = two<u8, bits_and<u8>>;
    t["or.pred"] = two<u8, bits_or<u8>>;
    t["xor.pred"] = two<u8, bits_xor<u8>>;
    t["not.pred"] = truth_not;
    t["mov.pred"] = move<u8>;
    t["cvta.to.global.u64"] = t["cvta.global.u64"] = move<u64>;
    t["cvta.param.u64"] = t["cvta.to.param.u64"] = move<u64>;
    for (const std::string mode : {"wrap", "clamp"}) {
        t["shf.l." + mode + ".b32"] = funnel_shift<true>;
        t["shf.r." + mode + ".b32"] = funnel_shift<false>;
    }
    t["mul.wide.s16"] = wide_product<s16, s32, false>;
    t["mul.wide.u16"] = wide_product<u16, u32, false>;
    t["mul.wide.s32"] = wide_product<s32, s64, false>;
    t["mul.wide.u32"] = wide_product<u32, u64, false>;
    t["mad.wide.s16"] = wide_product<s16, s32, true>;
    t["mad.wide.u16"] = wide_product<u16, u32, true>;
    t["mad.wide.s32"] = wide_product<s32, s64, true>;
    t["mad.wide.u32"] = wide_product<u32, u64, true>;
    t["prmt.b32"] = permute;
    t["lop3.b32"] = lookup;
    t["dp2a.lo.u32.u32"] = dot_two<u16, u8, false>;
    t["dp2a.lo.s32.u32"] = dot_two<s16, u8, false>;
    t["dp2a.hi.u32.u32"] = dot_two<u16, u8, true>;
    t["dp2a.hi.s32.u32"] = dot_two<s16, u8, true>;
    t["mov.b64.pack"] = pack<u32>;
    t["mov.b64.unpack"] = unpack<u32>;
    t["mov.b32.pack"] = pack<u16>;
    t["mov.b32.unpack"] = unpack<u16>;
    return t;
}

}  // namespace

PtxCompute find_computation(const std::string& opcode) {
    static const Table table = make_table();
    const auto found = table.find(opcode);
    return found == table.end() ? nullptr : found->second;
}

}  // namespace meniscus::benchmarks
