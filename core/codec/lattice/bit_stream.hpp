// Fields of some bits one after the other, the lowest bits first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "lattice/host_device.hpp"

namespace meniscus {

static_assert(std::endian::native == std::endian::little, "words are written as they lie in memory");

/// The word that is being filled.
struct BitWord {
    std::uint64_t bits = 0;
    int filled = 0;  ///< below 64

    /// count: 0 to 64; the value has no other bits. Calls store(word) with each word that is full.
    template <class Store>
    MENISCUS_HD void put(std::uint64_t value, int count, const Store& store) {
        bits |= value << filled;
        filled += count;
        if (filled < 64) return;
        store(bits);
        filled -= 64;
        // The bits that did not fit; a shift by 64 would be undefined.
        bits = filled == 0 ? 0 : value >> (count - filled);
    }
};

class BitWriter {
public:
    void clear() {
        count_ = 0;
        word_ = {};
    }
    /// Makes room for this many bits.
    void reserve(std::size_t bits) {
        const std::size_t words = count_ + bits / 64 + 2;
        if (words_.size() < words) words_.resize(words + words / 2);
    }
    /// bits: 0 to 64; the value has no others. There must be room.
    void put(std::uint64_t value, int bits) {
        word_.put(value, bits, [this](std::uint64_t word) { words_[count_++] = word; });
    }
    void append_to(std::vector<std::byte>& bytes) {
        words_[count_] = word_.bits;
        const std::size_t size = byte_count();
        const auto* const begin = reinterpret_cast<const std::byte*>(words_.data());
        bytes.insert(bytes.end(), begin, begin + size);
    }
    std::size_t byte_count() const { return 8 * count_ + static_cast<std::size_t>(word_.filled + 7) / 8; }

private:
    std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(64);
    std::size_t count_ = 0;
    BitWord word_;
};

/// Reads zeros behind the end, and says so.
class BitReader {
public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// bits: 0 to 56.
    std::uint64_t get_some(int bits) {
        const std::size_t at = position_ >> 3;
        std::uint64_t word = 0;
        if (at + 8 <= bytes_.size())
            std::memcpy(&word, bytes_.data() + at, 8);
        else if (at < bytes_.size())
            std::memcpy(&word, bytes_.data() + at, bytes_.size() - at);
        word >>= position_ & 7;
        position_ += static_cast<std::size_t>(bits);
        return word & ((std::uint64_t{1} << bits) - 1);
    }
    /// bits: 0 to 64.
    std::uint64_t get(int bits) {
        if (bits <= 56) return get_some(bits);
        const std::uint64_t low = get_some(32);
        return low | get_some(bits - 32) << 32;
    }
    /// Whether no more was read than there is.
    bool is_good() const { return position_ <= 8 * bytes_.size(); }
    /// The bytes behind the one that was begun last.
    std::span<const std::byte> rest() const { return bytes_.subspan((position_ + 7) / 8); }
    std::size_t bits_left() const { return is_good() ? 8 * bytes_.size() - position_ : 0; }

private:
    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
};

}  // namespace meniscus
