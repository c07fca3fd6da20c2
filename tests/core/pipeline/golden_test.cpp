// Meshes keep every bit from commit to commit: on the CPU. (On the software device: golden_emulated_test.cpp.)
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/instruction_set.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/reconstructor.hpp"
#include "support/golden_rows.hpp"
#include "support/particles.hpp"

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

TEST(Golden, MeshesKeepTheirBitsInParts) {
    std::size_t rows = 0;
    test::expect_golden_meshes([&](const test::GoldenRow& row, const ParticleFrame& frame) {
        if (row.max_level < 3) return reconstruct(row, frame, 1);  // parts have no capped levels
        AloneExchange alone;
        PartsReconstructor reconstructor(row.settings(), {Backend::cpu, 1}, {.parts = 2 + rows++ % 7}, alone);
        std::vector<Mesh> parts;
        reconstructor.reconstruct(frame, [&](const FinishedPart& part) {
            if (parts.size() <= part.number) parts.resize(part.number + 1);
            parts[part.number] = part.mesh;
        });
        return put_together(parts);
    });
}

/// The environment's choice, until the end of its life.
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

/// The first tolerance from `low` on that changes the mesh, and the hashes just before and at it.
struct Threshold {
    float before, at;
    std::string sha256_before, sha256_at;

    template <class Sha256>
    Threshold(float low, float high, const Sha256& sha256_with)
        : before(low), at(high), sha256_before(sha256_with(low)), sha256_at(sha256_with(high)) {
        while (std::nextafter(before, at) != at) {
            const float middle = before + 0.5F * (at - before);
            std::string sha256 = sha256_with(middle);
            (sha256 == sha256_before ? before : at) = middle;
            if (at == middle) sha256_at = std::move(sha256);
        }
    }
};

TEST(InstructionSets, ACellChangesItsLevelAtTheSameToleranceWithAllOfThem) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(0.0F, 0.25F);
    Settings settings = test::default_settings();
    settings.field = Field::smooth;
    settings.cell_size = 1.0;
    settings.normals = false;
    for (int scene = 0; scene < 12; ++scene) {
        SCOPED_TRACE(scene);
        test::Particles particles;
        for (int i = 0; i < 60; ++i) {
            const float x = place(random), y = place(random);
            particles.add(x, y, place(random));
        }
        const auto sha256_with = [&](float tolerance) {
            settings.criterion = CurvatureCriterion{double{tolerance}};
            return mesh_sha256(test::reconstruct(settings, particles.frame()));
        };
        const Threshold threshold(0.05F, 1.0F, sha256_with);
        EXPECT_NE(threshold.sha256_before, threshold.sha256_at);
        for (const InstructionSet set : usable_instruction_sets()) {
            SCOPED_TRACE(name_of(set));
            const WithInstructions with{std::string(name_of(set))};
            EXPECT_EQ(sha256_with(threshold.before), threshold.sha256_before);
            EXPECT_EQ(sha256_with(threshold.at), threshold.sha256_at);
        }
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
