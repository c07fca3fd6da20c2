// Recordings of a real meniscusd that meets the worst.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "formats/recordings/recording.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "sample_files.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using meniscus::test::TemporaryDirectory;

TEST(RecordingProcess, LeavesWholeFramesWhenItIsKilled) {
    const TemporaryDirectory directory;
    Process process(on_free_port({"--record", directory.path().string()}));
    client::Client client(process.address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id);
    const auto path = directory / id / "000001.recording";
    const auto written = [&] { return std::filesystem::exists(path) ? std::filesystem::file_size(path) : 0; };
    const Particles particles = wave(16, 0.0);
    for (std::uint64_t i = 0; i < 4 || written() < 100'000; ++i) {
        stream.push(particles.view(), i, 0.0);
        if (i > 1) {
            ASSERT_TRUE(stream.next());
        }
    }
    process.signal(SIGKILL);
    process.exit_code();
    const formats::Recording recording(path);
    ASSERT_GE(recording.frames().size(), 1U);
    for (std::size_t i = 0; i < recording.frames().size(); ++i) {
        const formats::RecordedFrame& frame = recording.frames()[i];
        EXPECT_EQ(frame.index, i);
        EXPECT_EQ(recording.particles(frame).positions, particles.positions);
        if (frame.mesh) {
            EXPECT_EQ(mesh_sha256(recording.mesh(frame).mesh()), local_sha256(particles));
        }
    }
}

TEST(RecordingProcess, IsAloneInItsFolderUntilItEndsHoweverItEnds) {
    const TemporaryDirectory directory;
    const auto arguments = on_free_port({"--record", directory.path().string()});
    Process process(arguments);
    process.address();
    Process second(arguments);
    const std::string said = second.rest();
    EXPECT_NE(said.find("records there: give each server a folder of its own"), std::string::npos) << said;
    EXPECT_EQ(second.exit_code(), 1) << "a later attempt may succeed";
    process.signal(SIGKILL);
    process.exit_code();
    Process third(arguments);
    EXPECT_NO_THROW(third.address());
}

/// Files of the processes started meanwhile may not grow further: to them it is a full disk.
class SmallFiles {
public:
    explicit SmallFiles(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit small = before_;
        small.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallFiles() { setrlimit(RLIMIT_FSIZE, &before_); }
    SmallFiles(const SmallFiles&) = delete;
    SmallFiles& operator=(const SmallFiles&) = delete;

private:
    rlimit before_{};
};

TEST(RecordingProcess, AFullDiskEndsTheRecordingAndNotTheSession) {
    constexpr std::uint64_t room = 200'000;
    const TemporaryDirectory directory;
    std::unique_ptr<Process> process;
    {
        const SmallFiles small(room);
        process = std::make_unique<Process>(on_free_port({"--record", directory.path().string()}));
    }
    client::Client client(process->address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id);
    const Particles particles = wave(16, 0.0);
    constexpr std::uint64_t frames = 12;  // of 49 kB each
    for (std::uint64_t i = 0; i < frames; ++i) {
        stream.push(particles.view(), i, 0.0);
        const auto frame = stream.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    }
    process->signal(SIGTERM);
    const std::string log = process->rest();
    EXPECT_NE(log.find("session " + id + ", frame "), std::string::npos) << log;
    EXPECT_NE(log.find(": its recording stops here"), std::string::npos) << log;
    EXPECT_EQ(process->exit_code(), 0);
    const formats::Recording recording(directory / id / "000001.recording");
    EXPECT_EQ(recording.bytes(), room);
    EXPECT_GT(recording.cut_bytes(), 0U);
    EXPECT_GE(recording.frames().size(), 2U);
    for (const formats::RecordedFrame& frame : recording.frames())
        EXPECT_EQ(recording.particles(frame).positions, particles.positions);
}

}  // namespace
}  // namespace meniscus::server::test
