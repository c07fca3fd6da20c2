// The fuzzing targets over their seeds and over damage to them: what every build can check without libFuzzer.
#include <gtest/gtest.h>

#include <ostream>
#include <random>

#include "mutation.hpp"
#include "targets.hpp"

namespace meniscus::fuzz {

/// For GoogleTest.
inline void PrintTo(const Target& target, std::ostream* out) {
    *out << target.name;
}

namespace {

struct FuzzTarget : testing::TestWithParam<Target> {};

TEST_P(FuzzTarget, TakesItsSeedsAndDamageToThem) {
    std::mt19937 random(1);
    const Seeds seeds = GetParam().seeds();
    ASSERT_FALSE(seeds.empty());
    for (const std::string& seed : seeds) {
        GetParam().run(seed);
        for (int round = 0; round < 300; ++round) GetParam().run(mutated(std::span(&seed, 1), random));
    }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTarget, testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace meniscus::fuzz
