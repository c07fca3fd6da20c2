// A particle file as the frame that is reconstructed: the arrays that the settings name, and those of a sequence.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "cli/surfaces/array_forms.hpp"
#include "cli/surfaces/particle_input.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::cli {
namespace {

class ParticleFile : public testing::Test {
protected:
    /// Two particles with a velocity, a density and an id.
    ParticleFile() {
        formats::write_file(
            path_,
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
            "z\nproperty float vx\nproperty float vy\nproperty float vz\nproperty float "
            "density\nproperty int id\nend_header\n0 0 0 1 2 3 0.5 7\n9 0 0 4 5 6 0.25 8\n");
    }
    ParticleInput read(const std::vector<std::string>& names, const ParticleInputOptions& options = {}) const {
        Settings settings;
        settings.particle_radius = 0.5;
        settings.attributes = names;
        return {path_, options, settings};
    }
    const test::TemporaryDirectory directory_;
    const std::filesystem::path path_ = directory_ / "p.ply";
};

TEST_F(ParticleFile, BringsTheArraysThatTheSettingsNameAndNoOthers) {
    const ParticleInput input = read({"velocity", "id"});
    const ParticleFrame frame = input.frame();
    ASSERT_EQ(frame.arrays.size(), 2U);
    EXPECT_EQ(frame.arrays[0].name, "velocity");
    EXPECT_EQ(frame.arrays[0].components, 3U);
    EXPECT_EQ(test::numbers_of<float>(frame.arrays[0]), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(frame.arrays[1].type, ElementType::int32);
    EXPECT_TRUE(read({}).frame().arrays.empty());
    Settings all;
    all.particle_radius = 0.5;
    all.all_attributes = true;
    EXPECT_EQ(ParticleInput(path_, {}, all).frame().arrays.size(), 3U);
}

TEST_F(ParticleFile, SaysWhichArraysItHasWhereOneIsMissing) {
    const std::string refused = test::refusal([&] { read({"speed"}); });
    for (const char* word : {"p.ply", "speed", "velocity", "density", "id"})
        EXPECT_NE(refused.find(word), std::string::npos) << word << " in: " << refused;
}

TEST_F(ParticleFile, LeavesOutTheArraysOfParticlesOutsideABoxToo) {
    ParticleInputOptions options;
    options.box = Box{{1.0, -1.0, -1.0}, {10.0, 1.0, 1.0}};
    for (const PositionEncoding encoding : {PositionEncoding::float32, PositionEncoding::uint16}) {
        options.positions = encoding;
        const ParticleInput input = read({"velocity"}, options);
        const ParticleFrame frame = input.frame();
        EXPECT_EQ(frame.count(), 1U);
        ASSERT_EQ(frame.arrays.size(), 1U);
        EXPECT_EQ(test::numbers_of<float>(frame.arrays[0]), (std::vector<float>{4, 5, 6}));
    }
}

TEST(ArraysOfASequence, KeepTheirTypeAndTheirComponents) {
    ArrayForms forms;
    const ParticleArray velocity{"velocity", {}, ElementType::float32, 3};
    const ParticleArray id{"id", {}, ElementType::uint32, 1};
    forms.require(std::array{velocity});
    forms.require(std::array{id, velocity});
    forms.require({});
    for (const ParticleArray& other : {ParticleArray{"velocity", {}, ElementType::float32, 4},
                                       ParticleArray{"velocity", {}, ElementType::uint8, 3}}) {
        const std::string refused = test::refusal([&] { forms.require(std::array{other}); });
        EXPECT_NE(refused.find("'velocity'"), std::string::npos) << refused;
        EXPECT_NE(refused.find("must be as in the frames before: float32 of 3 components"), std::string::npos)
            << refused;
    }
    const std::string id_refused = test::refusal([&] {
        forms.require(std::array{ParticleArray{"id", {}, ElementType::int32, 1}});
    });
    EXPECT_NE(id_refused.find("'id' is int32 of 1 component,"), std::string::npos) << id_refused;
}

}  // namespace
}  // namespace meniscus::cli
