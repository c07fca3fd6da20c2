#include "codec/lattice/rans.hpp"

namespace meniscus {
namespace {

/// 2^44 / frequency, rounded up: with it a multiplication divides a state of less than frequency * 2^20 exactly, for
/// the error stays below 2^-12.
struct Reciprocals {
    std::uint64_t of[probability_one + 1];
};
constexpr int reciprocal_bits = 44;
constexpr Reciprocals make_reciprocals() {
    Reciprocals reciprocals{};
    for (std::uint64_t f = 1; f <= probability_one; ++f)
        reciprocals.of[f] = ((std::uint64_t{1} << reciprocal_bits) + f - 1) / f;
    return reciprocals;
}
constexpr Reciprocals reciprocals = make_reciprocals();

}  // namespace

void RansEncoder::append_to(std::vector<std::byte>& bytes) {
    constexpr std::uint32_t states = 2;
    if (words_.size() < count_ + 2 * states) words_.resize(2 * count_ + 2 * states);
    std::uint16_t* const end = words_.data() + words_.size();
    std::uint16_t* at = end;
    std::array<std::uint32_t, states> state{RansDecoder::lowest, RansDecoder::lowest};
    // The decoder's order reversed; its first symbol comes of the second state.
    for (std::size_t i = count_; i-- > 0;) {
        std::uint32_t& s = state[(i & 1) ^ 1];
        const std::uint32_t start = steps_[i] >> 16;
        const std::uint32_t frequency = steps_[i] & 0xFFFF;
        if (frequency < probability_one && s >= frequency << 20) {
            *--at = static_cast<std::uint16_t>(s);
            s >>= 16;
        }
        const auto quotient = static_cast<std::uint32_t>(s * reciprocals.of[frequency] >> reciprocal_bits);
        s = (quotient << probability_bits) + (s - quotient * frequency) + start;
    }
    for (std::uint32_t i = states; i-- > 0;) {
        *--at = static_cast<std::uint16_t>(state[i]);
        *--at = static_cast<std::uint16_t>(state[i] >> 16);
    }
    const auto* const first = reinterpret_cast<const std::byte*>(at);
    bytes.insert(bytes.end(), first, reinterpret_cast<const std::byte*>(end));
}

}  // namespace meniscus
