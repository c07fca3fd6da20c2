// Which arithmetic an opcode of PTX names.
#include <string>
#include <unordered_map>

#include "model/ptx_arithmetic.hpp"
#include "model/ptx_module.hpp"

namespace meniscus::benchmarks {
namespace {

using namespace ptx_arithmetic;

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
