// BGEO and JSON: made files with known contents, and real ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "bgeo_sample.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "meniscus/mesh.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::test {
namespace {

formats::Particles read_sample(const std::string& bytes, std::uint64_t most = std::uint64_t{1} << 30) {
    return formats::read_bgeo("f", bytes, formats::ReadLimits{most});
}

TEST(BgeoReader, ReadsPointsVectorsAndIdsGzippedOrNot) {
    for (const std::string& bytes : {sample_bgeo(), gzipped(sample_bgeo())}) {
        const formats::Particles particles = read_sample(bytes);
        EXPECT_EQ(particles.positions, (std::vector<float>{1, 2, 3, 2, 3, 4}));
        ASSERT_EQ(particles.arrays.size(), 2U);
        EXPECT_EQ(particles.arrays[0].name, "velocity");
        EXPECT_EQ(particles.arrays[0].components, 3U);
        EXPECT_EQ(numbers_of<float>(particles.arrays[0]), (std::vector<float>{10, 20, 30, 11, 21, 31}));
        EXPECT_EQ(particles.arrays[1].name, "id");
        EXPECT_EQ(particles.arrays[1].type, ElementType::int32);
        EXPECT_EQ(numbers_of<std::int32_t>(particles.arrays[1]), (std::vector<std::int32_t>{7, -2}));
    }
}

TEST(BgeoReader, ReadsNoPoints) {
    EXPECT_EQ(read_sample(bgeo_header(0, 0)).count(), 0U);
}

TEST(BgeoReader, RefusesOtherFormatsVersionsAndTypes) {
    const auto message = [](const std::string& bytes) { return refusal([&] { read_sample(bytes); }); };
    EXPECT_NE(message("{\"fileversion\":1}").find("not a classic BGEO"), std::string::npos);
    std::string version = sample_bgeo();
    version[8] = 6;
    EXPECT_NE(message(version).find("BGEO version 6; 5 is read"), std::string::npos);
    EXPECT_NE(message(bgeo_header(1, 1) + bgeo_attribute("odd", 1, 9)).find("'odd' has type 9"), std::string::npos);
    EXPECT_NE(message(bgeo_header(-1, 0)).find("number of points is -1"), std::string::npos);
    EXPECT_NE(message(sample_bgeo().substr(0, 160)).find("truncated"), std::string::npos);
    const std::string cut = gzipped(sample_bgeo());
    EXPECT_NE(message(cut.substr(0, cut.size() / 2)).find("truncated"), std::string::npos);
}

TEST(BgeoReader, TakesNoMemoryForPointsThatAreNotThere) {
    // Two thousand million points are announced: 32 GB.
    const std::string header = bgeo_header(2'000'000'000, 0);
    for (const std::string& bytes : {header, gzipped(header + std::string(1000, '\0'))}) {
        EXPECT_NE(refusal([&] { read_sample(bytes); }).find("announce"), std::string::npos);
        EXPECT_NE(refusal([&] { read_sample(bytes, std::uint64_t{1} << 60); }).find("truncated"), std::string::npos);
    }
}

TEST(BgeoReader, TakesNoMoreMemoryForNamesThanAFileMayTake) {
    // Strings of a hundred bytes that compress to nothing, more of them than fit.
    constexpr std::int32_t strings = 20'000;
    std::string names = counted("material") + std::string{0, 1} + big(std::int32_t{4}) + big(strings);
    for (std::int32_t i = 0; i < strings; ++i) names += counted(std::string(100, 'a'));
    const std::string bytes = gzipped(bgeo_header(1, 1) + names + std::string(20, '\0'));
    ASSERT_LT(bytes.size(), 100'000U);
    EXPECT_EQ(read_sample(bytes).count(), 1U);
    EXPECT_NE(refusal([&] { read_sample(bytes, 200'000); }).find("bytes for a string, but only"), std::string::npos);
}

TEST(BgeoReader, StopsDecompressingBehindThePoints) {
    // Ten MB of zeros behind one point: never unpacked.
    std::string bytes = bgeo_header(1, 0) + big(1.0F) + big(2.0F) + big(3.0F) + big(1.0F);
    bytes.append(10'000'000, '\0');
    EXPECT_EQ(read_sample(gzipped(bytes), 1'000'000).count(), 1U);
}

TEST(BgeoReader, ReadsRealFrames) {
    const auto folder = data_folder();
    if (!folder) GTEST_SKIP() << "MENISCUS_DATA is not set";
    struct Frame {
        const char* name;
        std::size_t count;
        Point low, high;  ///< found by another program
    };
    const std::array frames{
        Frame{"dam_break_frame_23_24389_particles.bgeo",
              24389,
              {-1.51328325F, 0.031408947F, -0.764461875F},
              {1.51613569F, 3.9659164F, 0.765675366F}},
        Frame{"hilbert_46843_particles.bgeo",
              46843,
              {-1.19913852F, -1.19778073F, 0.0732697174F},
              {1.19976461F, 1.19306898F, 2.47148728F}},
    };
    for (const Frame& frame : frames) {
        const formats::Particles particles = formats::read_particles(*folder / "single_frames" / frame.name);
        ASSERT_EQ(particles.count(), frame.count);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float low = particles.positions[axis], high = low;
            for (std::size_t i = 0; i < particles.count(); ++i) {
                low = std::min(low, particles.positions[3 * i + axis]);
                high = std::max(high, particles.positions[3 * i + axis]);
            }
            EXPECT_EQ(low, frame.low[axis]);
            EXPECT_EQ(high, frame.high[axis]);
        }
    }
}

TEST(JsonReader, ReadsListsOfTriples) {
    EXPECT_EQ(formats::read_particle_json("f", "[[1, -2.5, 3e2],\n [0.1, 5, 6]]").positions,
              (std::vector<float>{1.0F, -2.5F, 300.0F, 0.1F, 5.0F, 6.0F}));
    EXPECT_EQ(formats::read_particle_json("f", "[]").count(), 0U);
    // An origin is subtracted from the float64 of the file.
    EXPECT_NEAR(formats::read_particle_json("f", "[[1000000.01, 2, 3]]").coordinate(0), 1'000'000.01, 1e-9);
}

TEST(JsonReader, RefusesEverythingElseByItsPlace) {
    const auto message = [](const std::string& bytes) {
        return refusal([&] { formats::read_particle_json("f", bytes); });
    };
    EXPECT_NE(message("[[1, 2, 3], [1, 2]]").find("a position of 2 numbers after 1 whole"), std::string::npos);
    for (const char* text :
         {"[1, 2, 3]", "[[1, 2, 3, 4]]", "[[[1]]]", "{\"a\": 1}", "[[\"1\", 2, 3]]", "[null]", "7", "[[1, 2, 3]"})
        EXPECT_NE(message(text), "") << text;
    EXPECT_NE(message("[[1, 2, 1e300]]").find("beyond float32"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
