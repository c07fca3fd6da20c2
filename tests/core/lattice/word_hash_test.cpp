// The identity of words in their places: no two of many alike contents share one of its two sums.
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

#include "lattice/word_hash.hpp"

namespace meniscus {
namespace {

using Words = std::vector<std::uint64_t>;

/// Collects the hashes of contents that all differ.
class Hashes {
public:
    void add(const Words& words) {
        WordHash hash{};
        for (std::size_t i = 0; i < words.size(); ++i) hash.add(words[i], i);
        ++contents_;
        for (int i = 0; i < 2; ++i) sums_[i].insert(hash.of[i]);
    }
    /// Half of the hash is enough for so few.
    void expect_all_different() const {
        for (const auto& sums : sums_) EXPECT_EQ(sums.size(), contents_);
    }

private:
    std::set<std::uint64_t> sums_[2];
    std::size_t contents_ = 0;
};

TEST(WordHash, DoesNotDependOnTheOrderOfTheAdditions) {
    WordHash forward{};
    WordHash backward{};
    for (std::uint64_t i = 0; i < 100; ++i) forward.add(i * i, i);
    for (std::uint64_t i = 100; i-- > 0;) backward.add(i * i, i);
    EXPECT_EQ(forward.of[0], backward.of[0]);
    EXPECT_EQ(forward.of[1], backward.of[1]);
    EXPECT_NE(forward.of[0], forward.of[1]);
}

TEST(WordHash, TellsSmallWordsInAnyPlacesApart) {
    Hashes hashes;
    for (std::uint64_t a = 0; a < 50; ++a)
        for (std::uint64_t b = 0; b < 50; ++b)
            for (std::uint64_t c = 0; c < 50; ++c) hashes.add({a, b, c});
    hashes.expect_all_different();
}

TEST(WordHash, TellsTwoFlippedBitsApart) {
    Hashes hashes;
    constexpr std::size_t bits = 8 * 64;
    const auto flipped = [](std::size_t first, std::size_t second) {
        Words words(bits / 64, 0);
        words[first / 64] ^= std::uint64_t{1} << first % 64;
        if (second != first) words[second / 64] ^= std::uint64_t{1} << second % 64;
        return words;
    };
    for (std::size_t first = 0; first < bits; ++first)
        for (std::size_t second = first; second < bits; ++second) hashes.add(flipped(first, second));
    hashes.expect_all_different();
}

TEST(WordHash, TellsOneWordInEachPlaceApart) {
    Hashes hashes;
    for (std::size_t place = 0; place < 500; ++place)
        for (const std::uint64_t word : {std::uint64_t{1}, ~std::uint64_t{0}}) {
            Words words(500, 0);
            words[place] = word;
            hashes.add(words);
        }
    hashes.expect_all_different();
}

TEST(WordHash, TellsLengthsOfZerosApart) {
    Hashes hashes;
    for (std::size_t length = 0; length < 2000; ++length) hashes.add(Words(length, 0));
    hashes.expect_all_different();
}

}  // namespace
}  // namespace meniscus
