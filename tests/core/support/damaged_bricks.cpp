#include "support/damaged_bricks.hpp"

#include <random>

namespace meniscus::test {

std::vector<EncodedBrick> damaged(const EncodedBrick& whole, int flipped) {
    std::vector<EncodedBrick> bricks;
    for (std::size_t size = 0; size < whole.data.size(); size += 1 + size / 16)
        bricks.emplace_back(whole).data.resize(size);
    std::mt19937 random(5);
    std::uniform_int_distribution<std::size_t> place(0, whole.data.size() - 1);
    for (int i = 0; i < flipped; ++i) {
        EncodedBrick& brick = bricks.emplace_back(whole);
        for (int k = 0; k <= i % 3; ++k) brick.data[place(random)] ^= static_cast<std::byte>(1U << (random() % 8));
    }
    return bricks;
}

}  // namespace meniscus::test
