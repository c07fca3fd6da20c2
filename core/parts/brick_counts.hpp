// Counts of particles by brick, in a table that a rank's bricks fit into the cache with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace meniscus {

class BrickCounts {
public:
    struct Count {
        std::uint64_t key = 0;  ///< brick_key
        std::uint64_t particles = 0;
    };

    /// Particles in the brick of this key, at least one.
    void add(std::uint64_t key, std::uint64_t particles) {
        Count& count = slot_of(key);
        const bool is_there = count.particles != 0;
        count.particles += particles;
        if (is_there) return;
        count.key = key;
        if (++bricks_ > slots_.size() / 2) grow();
    }
    /// In no order.
    std::vector<Count> take() {
        std::erase_if(slots_, [](const Count& count) { return count.particles == 0; });
        return std::exchange(slots_, {});
    }

private:
    Count& slot_of(std::uint64_t key) {
        constexpr std::uint64_t odd = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio
        std::size_t at = (key * odd) >> (64 - bits_);
        while (slots_[at].particles != 0 && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
        return slots_[at];
    }
    void grow() {
        ++bits_;
        const std::vector<Count> before = std::exchange(slots_, std::vector<Count>(std::size_t{1} << bits_));
        for (const Count& count : before)
            if (count.particles != 0) slot_of(count.key) = count;
    }

    unsigned bits_ = 10;
    std::vector<Count> slots_ = std::vector<Count>(std::size_t{1} << bits_);
    std::size_t bricks_ = 0;
};

}  // namespace meniscus
