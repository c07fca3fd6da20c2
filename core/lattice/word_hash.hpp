// The identity of words in their places: two sums over them, so that a device may add in any order.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus {

/// Equal for equal words in equal places; different ones have the same hash with a chance of about 2^-128. Not proof
/// against forgery.
struct WordHash {
    std::uint64_t of[2];

    MENISCUS_HD void add(std::uint64_t word, std::uint64_t index) {
        of[0] += mixed(word, 2 * index);
        of[1] += mixed(word, 2 * index + 1);
    }

private:
    /// Mixes all bits of the word with a state of SplitMix64, one for each key, by its finalizer. (Steele, Lea, Flood
    /// 2014: Fast splittable pseudorandom number generators)
    MENISCUS_HD static std::uint64_t mixed(std::uint64_t word, std::uint64_t key) {
        return finalized(word ^ (key + 1) * 0x9E3779B97F4A7C15);
    }
    MENISCUS_HD static std::uint64_t finalized(std::uint64_t bits) {
        bits = (bits ^ bits >> 30) * 0xBF58476D1CE4E5B9;
        bits = (bits ^ bits >> 27) * 0x94D049BB133111EB;
        return bits ^ bits >> 31;
    }
};

}  // namespace meniscus
