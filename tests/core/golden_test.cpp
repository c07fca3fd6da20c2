// Meshes keep every bit from commit to commit: on the CPU. (On the software device: golden_emulated_test.cpp.)
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "instruction_set.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "support/golden_rows.hpp"

namespace meniscus {
namespace {

/// Rows differ in their settings, so each has a reconstructor of its own.
Mesh reconstruct(const test::GoldenRow& row, const ParticleFrame& frame, unsigned threads) {
    Reconstructor reconstructor(row.settings(), {Backend::cpu, threads});
    Mesh mesh;
    reconstructor.reconstruct(frame, mesh);
    if (row.max_level < 3) reconstructor.emit_capped(row.max_level, mesh);
    return mesh;
}

TEST(Golden, MeshesKeepTheirBits) {
    test::expect_golden_meshes(
        [](const test::GoldenRow& row, const ParticleFrame& frame) { return reconstruct(row, frame, 1); });
}

TEST(Golden, MeshesKeepTheirBitsOnThreeThreads) {
    test::expect_golden_meshes(
        [](const test::GoldenRow& row, const ParticleFrame& frame) { return reconstruct(row, frame, 3); });
}

/// As the environment says, until the end of its life.
class WithInstructions {
public:
    explicit WithInstructions(const std::string& set) { setenv("MENISCUS_INSTRUCTIONS", set.c_str(), 1); }
    ~WithInstructions() { unsetenv("MENISCUS_INSTRUCTIONS"); }
    WithInstructions(const WithInstructions&) = delete;
    WithInstructions& operator=(const WithInstructions&) = delete;
};

TEST(Golden, MeshesKeepTheirBitsWithEveryInstructionSet) {
    for (const InstructionSet set : usable_instruction_sets()) {
        SCOPED_TRACE(name_of(set));
        const WithInstructions with{std::string(name_of(set))};
        EXPECT_TRUE(describe_backend(Backend::cpu).device.ends_with(", " + std::string(name_of(set))));
        test::expect_golden_meshes(
            [](const test::GoldenRow& row, const ParticleFrame& frame) { return reconstruct(row, frame, 1); });
    }
}

TEST(InstructionSets, OneThatIsNotThereIsRefusedWithThoseThatAre) {
    const WithInstructions with("avx9");
    try {
        Reconstructor reconstructor(test::golden_rows().front().settings(), {Backend::cpu, 1});
        FAIL() << "it was accepted";
    } catch (const InvalidInput& refusal) {
        const std::string text = refusal.what();
        EXPECT_NE(text.find("MENISCUS_INSTRUCTIONS is \"avx9\""), std::string::npos) << text;
        EXPECT_NE(text.find("portable"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace meniscus
