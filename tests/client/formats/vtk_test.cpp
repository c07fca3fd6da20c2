#include <gtest/gtest.h>

#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/particles/vtk_writer.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

using formats::Particles;
using formats::read_vtk;

const std::vector<float> sample_positions{1, 2, 3, 4, 5, 6};
const std::vector<std::uint8_t> sample_levels{0, 3};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(VtkReader, ReadsBinaryPointsAndLevelsAmongOtherArrays) {
    const Particles particles = read_vtk("f", vtk_binary());
    EXPECT_EQ(particles.positions, sample_positions);
    EXPECT_EQ(particles.levels, sample_levels);
}

TEST(VtkReader, ReadsAsciiWithOffsetsAndMetadata) {
    const Particles particles = read_vtk("f", vtk_ascii());
    EXPECT_EQ(particles.positions, sample_positions);
    EXPECT_EQ(particles.levels, sample_levels);
}

TEST(VtkReader, ReadsScalarsWithoutLookupTable) {
    const Particles particles = read_vtk("f", replaced(vtk_ascii(), "LOOKUP_TABLE default\n", ""));
    EXPECT_EQ(particles.levels, sample_levels);
}

TEST(VtkReader, ReadsWindowsLineEnds) {
    std::string text;
    for (const char c : vtk_ascii()) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(read_vtk("f", text).positions, sample_positions);
}

TEST(VtkReader, IgnoresAFloatingPointLevel) {
    EXPECT_TRUE(read_vtk("f", replaced(vtk_ascii(), "SCALARS level int", "SCALARS level float")).levels.empty());
}

TEST(VtkReader, IgnoresLevelsOfCells) {
    EXPECT_TRUE(read_vtk("f", replaced(vtk_ascii(), "POINT_DATA 2\nVECTORS", "CELL_DATA 2\nVECTORS")).levels.empty());
}

TEST(VtkReader, ReadsNoParticles) {
    const Particles particles =
        read_vtk("f", "# vtk DataFile Version 4.1\nt\nBINARY\nDATASET POLYDATA\nPOINTS 0 float\n");
    EXPECT_EQ(particles.count(), 0U);
}

TEST(VtkReader, CountsTheFacesOfAMeshAndNoVerticesOrLines) {
    for (const std::string& text : {vtk_binary(), vtk_ascii()}) EXPECT_EQ(read_vtk("f", text).faces, 0U);
    const std::string points =
        "# vtk DataFile Version 4.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
    EXPECT_EQ(read_vtk("f", points + "VERTICES 3 6\n1 0 1 1 1 2\nLINES 1 3\n2 0 1\n").faces, 0U);
    EXPECT_EQ(read_vtk("f", points + "POLYGONS 2 8\n3 0 1 2 3 2 1 0\n").faces, 2U);
    EXPECT_EQ(read_vtk("f", points + "TRIANGLE_STRIPS 1 4\n3 0 1 2\n").faces, 1U);
    const std::string newer = replaced(points, "4.1", "5.1");
    EXPECT_EQ(
        read_vtk("f", newer + "POLYGONS 3 6\nOFFSETS vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 2 2 1 0\n")
            .faces,
        2U);
    const std::string grid = replaced(points, "POLYDATA", "UNSTRUCTURED_GRID");
    EXPECT_EQ(read_vtk("f", grid + "CELLS 3 10\n1 0 2 0 1 4 0 1 2 0\nCELL_TYPES 3\n1 3 9\n").faces, 1U);
}

TEST(VtkReader, RefusesACountBeyondTheFile) {
    const std::string message =
        refusal([] { read_vtk("f", replaced(vtk_binary(), "POINTS 2 ", "POINTS 4000000000 ")); });
    EXPECT_NE(message.find("12000000000 coordinates"), std::string::npos) << message;
    EXPECT_NE(message.find("bytes follow"), std::string::npos) << message;
}

TEST(VtkReader, RefusesACountThatDoesNotMatchTheBytes) {
    EXPECT_NE(refusal([] { read_vtk("f", replaced(vtk_binary(), "POINTS 2 ", "POINTS 1 ")); }), "");
    EXPECT_NE(refusal([] { read_vtk("f", replaced(vtk_binary(), "POINTS 2 ", "POINTS 3 ")); }), "");
    EXPECT_NE(refusal([] { read_vtk("f", replaced(vtk_ascii(), "POINTS 2 ", "POINTS 1 ")); }), "");
}

TEST(VtkReader, RefusesALevelAboveTheLimitByName) {
    const std::string message = refusal([] { read_vtk("f", replaced(vtk_ascii(), "default\n0 3", "default\n0 4")); });
    EXPECT_NE(message.find("level 4 of particle 1"), std::string::npos) << message;
    EXPECT_NE(message.find("0 to 3"), std::string::npos) << message;
}

TEST(VtkReader, RefusesACoordinateBeyondFloat32) {
    EXPECT_NE(refusal([] { read_vtk("f", replaced(vtk_ascii(), "1 2 3", "1 2e300 3")); }).find("2e+300 of particle 0"),
              std::string::npos);
}

TEST(VtkReader, RefusesOtherVersionsAndDatasets) {
    EXPECT_NE(refusal([] { read_vtk("f", replaced(vtk_ascii(), "Version 5.1", "Version 6.0")); }).find("6.0"),
              std::string::npos);
    EXPECT_NE(refusal([] {
                  read_vtk("f", replaced(vtk_ascii(), "UNSTRUCTURED_GRID", "STRUCTURED_POINTS"));
              }).find("STRUCTURED_POINTS"),
              std::string::npos);
}

TEST(VtkWriter, IsReadBack) {
    const TemporaryDirectory directory;
    Particles particles;
    particles.positions = {0.1F, -2.5F, 3e7F, 4.0F, 5.0F, 6.0F};
    particles.levels = {1, 0};
    formats::write_vtk(directory / "p.vtk", particles.frame());
    const Particles back = formats::read_particles(directory / "p.vtk");
    EXPECT_EQ(back.positions, particles.positions);
    EXPECT_EQ(back.levels, particles.levels);
}

TEST(VtkReader, ReadsRealFrames) {
    const auto folder = data_folder();
    if (!folder) GTEST_SKIP() << "MENISCUS_DATA is not set";
    EXPECT_EQ(formats::read_particles(*folder / "double_dam_break_with_sphere/frame_040.vtk").count(), 11492U);
    EXPECT_EQ(formats::read_particles(*folder / "single_frames/bunny_frame_14_7705_particles.vtk").count(), 7706U);
    EXPECT_EQ(formats::read_particles(*folder / "single_frames/free_particles_1000_particles.vtk").count(), 1000U);
    EXPECT_EQ(formats::read_particles(*folder / "single_frames/double_dam_break_frame_26_4732_particles.vtk").count(),
              4732U);
    const Particles cube = formats::read_particles(*folder / "single_frames/cube_8_particles.vtk");
    ASSERT_EQ(cube.count(), 8U);
    EXPECT_EQ(cube.positions[1], 0.4995095F);
}

}  // namespace
}  // namespace meniscus::test
