// Range asymmetric numeral systems (Duda 2013) with constant tables: symbols to 16-bit words and back.
//
// Probabilities are multiples of 2^-12. Two states take turns, so that one symbol need not wait for the other; the
// decoder starts from the states that the encoder ends with, and ends with those that the encoder started from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace meniscus {

inline constexpr int probability_bits = 12;
inline constexpr std::uint32_t probability_one = 1U << probability_bits;

/// For each context, the sums of the probabilities of the symbols before each. Every symbol has some probability.
template <int symbols, int contexts>
struct Distributions {
    static constexpr int symbol_count = symbols;
    static constexpr int context_count = contexts;
    std::uint16_t start[contexts][symbols];

    std::uint32_t end(int context, int symbol) const {
        return symbol + 1 < symbols ? start[context][symbol + 1] : probability_one;
    }
};

/// For each context and each sixteenth of its symbols' places, the first symbol there: a table of many symbols is then
/// looked up in a few steps.
template <int symbols, int contexts>
class SymbolIndex {
public:
    static constexpr int shift = 4;

    explicit SymbolIndex(const Distributions<symbols, contexts>& table) {
        for (int c = 0; c < contexts; ++c) {
            int symbol = 0;
            for (std::uint32_t i = 0; i < places; ++i) {
                while (symbol + 1 < symbols && table.start[c][symbol + 1] <= i << shift) ++symbol;
                first_[c][i] = static_cast<std::uint8_t>(symbol);
            }
        }
    }
    int first(int context, std::uint32_t low) const { return first_[context][low >> shift]; }

private:
    static constexpr std::uint32_t places = probability_one >> shift;
    std::uint8_t first_[contexts][places];
};

class RansEncoder {
public:
    static constexpr bool encodes = true;

    void clear() { count_ = 0; }
    /// Makes room for this many symbols.
    void reserve(std::size_t symbols) {
        if (steps_.size() < count_ + symbols) steps_.resize(2 * (count_ + symbols));
    }
    template <int symbols, int contexts>
    int code(const Distributions<symbols, contexts>& table, int context, int symbol) {
        const std::uint32_t start = table.start[context][symbol];
        steps_[count_++] = start << 16 | (table.end(context, symbol) - start);
        return symbol;
    }
    template <int symbols, int contexts>
    int code(const Distributions<symbols, contexts>& table, const SymbolIndex<symbols, contexts>&, int context,
             int symbol) {
        return code(table, context, symbol);
    }
    void append_to(std::vector<std::byte>& bytes);

private:
    std::vector<std::uint32_t> steps_;  ///< start << 16 | frequency
    std::size_t count_ = 0;
    std::vector<std::uint16_t> words_;
};

/// Reads zeros behind the end.
class RansDecoder {
public:
    static constexpr bool encodes = false;

    /// Returns false if there are too few bytes.
    bool start(std::span<const std::byte> bytes) {
        bytes_ = bytes;
        at_ = turn_ = 0;
        if (bytes.size() < state_bytes || bytes.size() % 2 != 0) return false;
        for (std::uint32_t& state : states_) {
            state = static_cast<std::uint32_t>(word()) << 16;
            state |= word();
        }
        return true;
    }
    void reserve(std::size_t) {}
    template <int symbols, int contexts>
    int code(const Distributions<symbols, contexts>& table, int context, int /*symbol*/) {
        static_assert(symbols <= 16, "look up more symbols by their index");
        const std::uint32_t low = states_[turn_ ^ 1] & (probability_one - 1);
        int symbol = 0;
        for (int i = 1; i < symbols; ++i) symbol += table.start[context][i] <= low ? 1 : 0;
        return take(table.start[context][symbol], table.end(context, symbol), symbol);
    }
    template <int symbols, int contexts>
    int code(const Distributions<symbols, contexts>& table, const SymbolIndex<symbols, contexts>& index, int context,
             int /*symbol*/) {
        const std::uint32_t low = states_[turn_ ^ 1] & (probability_one - 1);
        int symbol = index.first(context, low);
        while (table.end(context, symbol) <= low) ++symbol;
        return take(table.start[context][symbol], table.end(context, symbol), symbol);
    }
    /// Whether more was read than there is.
    bool has_run_over() const { return at_ > bytes_.size(); }
    /// Whether all was read, and no more.
    bool is_at_end() const { return at_ == bytes_.size() && states_[0] == lowest && states_[1] == lowest; }

    static constexpr std::uint32_t lowest = 1U << 16;  ///< of a state between two symbols

private:
    static constexpr std::size_t state_bytes = 8;

    int take(std::uint32_t start, std::uint32_t end, int symbol) {
        std::uint32_t& state = states_[turn_ ^= 1];
        state = (end - start) * (state >> probability_bits) + (state & (probability_one - 1)) - start;
        if (state < lowest) state = state << 16 | word();
        return symbol;
    }
    std::uint32_t word() {
        std::uint16_t value = 0;
        if (at_ + 2 <= bytes_.size()) std::memcpy(&value, bytes_.data() + at_, 2);
        at_ += 2;
        return value;
    }

    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    std::array<std::uint32_t, 2> states_{};
    unsigned turn_ = 0;
};

}  // namespace meniscus
