#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
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

TEST(XyzReader, RefusesTextThatHasTheSizeOfTriples) {
    for (const char* text : {"0.1 0.2 0.3\n", "1e3,-2,+3.5\n"})
        EXPECT_NE(refusal([&] { formats::read_xyz("f", text); }).find("it is text"), std::string::npos) << text;
}

TEST(ReadParticles, RefusesMissingFilesFoldersAndUnknownExtensions) {
    const TemporaryDirectory directory;
    EXPECT_NE(refusal([&] { formats::read_particles(directory / "none.vtk"); }).find("no such file"),
              std::string::npos);
    std::filesystem::create_directory(directory / "folder.xyz");
    EXPECT_NE(refusal([&] { formats::read_particles(directory / "folder.xyz"); }).find("not a regular file"),
              std::string::npos);
    EXPECT_NE(refusal([&] { formats::read_particles("a.pvtu"); }).find("'.pvtu'"), std::string::npos);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const TemporaryDirectory directory;
    {
        formats::AtomicFile file(directory / "a");
        file.write("half");
    }
    EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

/// The message of the exception; empty without one.
std::string failure(const std::function<void()>& call) {
    try {
        call();
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return {};
}

TEST(AtomicFile, SaysWhyAWriteFailedAndLeavesNothing) {
    EXPECT_NE(failure([] { formats::write_file("/dev/full", "x"); }).find("No space left on device"),
              std::string::npos);
    const TemporaryDirectory directory;
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{4096, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    for (const std::size_t size : {std::size_t{5000}, std::size_t{3} << 20})
        EXPECT_NE(failure([&] { formats::write_file(directory / "a", std::string(size, 'x')); }).find("File too large"),
                  std::string::npos);
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(AtomicFile, WritesAPipeAsItIsAndHoldsAllThatIsWritten) {
    const TemporaryDirectory directory;
    ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
    std::string bytes(std::size_t{3} << 20, 'x');
    bytes.back() = 'y';
    auto reading = std::async(std::launch::async, [&] {
        std::ifstream in(directory / "pipe", std::ios::binary);
        return std::string{std::istreambuf_iterator<char>(in), {}};
    });
    formats::AtomicFile file(directory / "pipe");
    for (std::size_t at = 0; at < bytes.size(); at += 100'000)
        file.write(std::string_view(bytes).substr(at, std::min<std::size_t>(100'000, bytes.size() - at)));
    file.commit();
    EXPECT_TRUE(reading.get() == bytes);
    EXPECT_TRUE(std::filesystem::is_fifo(directory / "pipe"));
}

// /dev/stdout is such a link, and everybody misses it once a file has taken its place.
TEST(AtomicFile, LeavesALinkAndReplacesWhatItLeadsTo) {
    const TemporaryDirectory directory;
    std::filesystem::create_directory(directory / "links");
    formats::write_file(directory / "file", "old");
    std::filesystem::create_symlink(directory / "file", directory / "links/one");
    std::filesystem::create_symlink("one", directory / "links/two");
    formats::write_file(directory / "links/two", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "links/two"));
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "links/one"));
    EXPECT_EQ(formats::read_file(directory / "file"), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory / "links"), {}), 2);
}

TEST(AtomicFile, RefusesAPathThatCannotBeWritten) {
    const TemporaryDirectory directory;
    EXPECT_NE(refusal([&] { formats::write_file(directory / "no/such/folder", "x"); }).find("cannot be written"),
              std::string::npos);
    EXPECT_NE(refusal([&] { formats::write_file(directory.path(), "x"); }).find("directory"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
