// A number that tells contents apart: fast, not proof against forgery.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace meniscus {

/// Takes eight bytes at a time: each is mixed in by a step that loses nothing, so that contents which differ in one
/// place always differ, and others meet with a chance of about 2^-64.
class ContentHash {
public:
    template <class T>
    void add(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto bytes = std::as_bytes(values);
        mix(bytes.size());
        for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
            mix(word);
        }
    }

    std::uint64_t value() const noexcept { return state_; }

private:
    void mix(std::uint64_t word) noexcept {
        state_ = (state_ ^ word) * 0x9e3779b97f4a7c15U;  // odd, its bits without a pattern: 2^64 over the golden ratio
        state_ ^= state_ >> 32U;
    }

    std::uint64_t state_ = 0;
};

}  // namespace meniscus
