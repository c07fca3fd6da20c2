#include <gtest/gtest.h>

#include "formats/atomic_file.hpp"
#include "formats/particles.hpp"
#include "formats/scalar.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

TEST(XyzReader, ReadsLittleEndianTriples) {
    std::string bytes;
    for (const float x : {1.5F, -2.0F, 3e20F}) formats::store(bytes, x);
    EXPECT_EQ(formats::read_xyz("f", bytes).positions, (std::vector<float>{1.5F, -2.0F, 3e20F}));
    EXPECT_EQ(formats::read_xyz("f", "").count(), 0U);
}

TEST(XyzReader, RefusesASizeThatIsNoMultipleOfTwelve) {
    const std::string message = refusal([] { formats::read_xyz("f", std::string(13, '\0')); });
    EXPECT_NE(message.find("13 bytes"), std::string::npos) << message;
    EXPECT_NE(message.find("multiple of 12"), std::string::npos) << message;
}

TEST(ReadParticles, RefusesMissingFilesFoldersAndUnknownExtensions) {
    const TemporaryDirectory directory;
    EXPECT_NE(refusal([&] { formats::read_particles(directory / "none.vtk"); }).find("no such file"),
              std::string::npos);
    std::filesystem::create_directory(directory / "folder.xyz");
    EXPECT_NE(refusal([&] { formats::read_particles(directory / "folder.xyz"); }).find("not a regular file"),
              std::string::npos);
    EXPECT_NE(refusal([&] { formats::read_particles("a.vtu"); }).find("'.vtu'"), std::string::npos);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const TemporaryDirectory directory;
    {
        formats::AtomicFile file(directory / "a");
        file.write("half");
    }
    EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(AtomicFile, RefusesAPathThatCannotBeWritten) {
    const TemporaryDirectory directory;
    EXPECT_NE(refusal([&] { formats::write_file(directory / "no/such/folder", "x"); }).find("cannot be written"),
              std::string::npos);
    EXPECT_NE(refusal([&] { formats::write_file(directory.path(), "x"); }).find("directory"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
