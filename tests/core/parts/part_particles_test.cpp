// What a process keeps of the particles that it has been handed.
#include "parts/part_particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "support/attributes.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// Whether a span lies in the memory of another.
template <class T>
bool is_the_same(std::span<const T> a, std::span<const T> b) {
    return a.data() == b.data() && a.size() == b.size();
}

TEST(PartParticles, CopyWhatDoesNotStayAndNothingElse) {
    test::ParticlesWithArrays all = test::with_noise(test::splash(71, 5), 71);
    all.particles.levels.assign(all.particles.count(), 1);
    const ParticleFrame given = all.frame();
    ASSERT_FALSE(given.arrays.empty());
    for (const bool positions_stay : {false, true})
        for (const bool rest_stays : {false, true}) {
            PartParticles kept_here;
            const ParticleFrame kept = kept_here.keep({given, positions_stay, rest_stays});
            EXPECT_EQ(is_the_same(kept.positions, given.positions), positions_stay);
            EXPECT_EQ(is_the_same(kept.levels, given.levels), rest_stays);
            EXPECT_TRUE(std::ranges::equal(kept.positions, given.positions));
            EXPECT_TRUE(std::ranges::equal(kept.levels, given.levels));
            ASSERT_EQ(kept.arrays.size(), given.arrays.size());
            for (std::size_t a = 0; a < kept.arrays.size(); ++a) {
                EXPECT_EQ(kept.arrays[a].name, given.arrays[a].name);
                EXPECT_EQ(is_the_same(kept.arrays[a].data, given.arrays[a].data), rest_stays);
                EXPECT_TRUE(std::ranges::equal(kept.arrays[a].data, given.arrays[a].data));
            }
        }
}

}  // namespace
}  // namespace meniscus
