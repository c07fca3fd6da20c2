// Recordings of real sessions, and the commands that read them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands/command_line.hpp"
#include "cli/sequence/replay_pace.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "observation/metrics.hpp"
#include "recording/recording_writer.hpp"
#include "running_server.hpp"
#include "sample_files.hpp"

namespace meniscus::server::test {
namespace {

using formats::Recording;
using meniscus::test::TemporaryDirectory;

ServerOptions recorded_in(const std::filesystem::path& directory) {
    ServerOptions options = test_options();
    options.recording.directory = directory;
    return options;
}

int meniscus(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "meniscus");
    std::vector<const char*> argv;
    argv.reserve(arguments.size());
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    return cli::run(static_cast<int>(argv.size()), argv.data());
}

/// Every encoding, levels, an empty frame; indices with a gap.
std::vector<Particles> frames() {
    std::vector<Particles> frames{wave(8, 0.0), quantized(wave(8, 1.0)), wave(8, 2.0), {}, wave(48, 3.0)};
    frames[2].levels.assign(frames[2].positions.size() / 3, 0);
    frames[2].levels[17] = 1;
    return frames;
}

std::uint64_t index_of(std::size_t frame) {
    return 10 + 3 * frame;
}

class RecordedSession : public testing::Test {
protected:
    /// Streams all frames to a server that records them, and returns its only recording.
    std::filesystem::path record(const client::StreamOptions& options = {}) {
        RunningServer running(recorded_in(folder("recorded")));
        const std::string id = running.session();
        auto stream = running.client.stream(id, options);
        for (std::size_t i = 0; i < frames().size(); ++i)
            stream.push(frames()[i].view(), index_of(i), 0.5 * static_cast<double>(i));
        stream.finish();
        while (stream.next()) {
        }
        return directory_ / "recorded" / id / "000001.recording";
    }
    std::string folder(const std::string& name) const { return (directory_ / name).string(); }

    TemporaryDirectory directory_;
};

void expect_meshes_of_all_frames(const Recording& recording) {
    ASSERT_EQ(recording.frames().size(), frames().size());
    for (std::size_t i = 0; i < frames().size(); ++i) {
        const formats::RecordedFrame& frame = recording.frames()[i];
        EXPECT_EQ(frame.index, index_of(i));
        EXPECT_EQ(frame.simulation_time, 0.5 * static_cast<double>(i));
        ASSERT_TRUE(frame.mesh);
        EXPECT_EQ(mesh_sha256(recording.mesh(frame).mesh()), local_sha256(frames()[i]));
    }
}

TEST_F(RecordedSession, HoldsEveryFrameWithItsMesh) {
    const Recording recording(record());
    EXPECT_EQ(recording.settings(), in_force(settings()));
    EXPECT_EQ(recording.cut_bytes(), 0U);
    expect_meshes_of_all_frames(recording);
}

TEST_F(RecordedSession, HoldsMeshesThatNobodyAskedFor) {
    expect_meshes_of_all_frames(Recording(record({.receive_meshes = false})));
}

TEST_F(RecordedSession, GivesTheSameMeshesWhenItIsReplayed) {
    const auto recorded = record();
    const std::string session = client::new_session_id();
    {
        RunningServer other(recorded_in(folder("replayed")));
        ASSERT_EQ(meniscus({"replay", recorded.parent_path().string(), "--server", other.server.address(), "--session",
                            session, "--speed", "max"}),
                  0);
        EXPECT_TRUE(other.client.sessions().empty());
    }
    expect_meshes_of_all_frames(Recording(directory_ / "replayed" / session / "000001.recording"));
}

TEST_F(RecordedSession, KeepsItsNameAndIsReplayedUnderItOrAnother) {
    const client::SessionDescription named{.name = "w\u00e4ve", .up_axis = client::UpAxis::z, .length_unit = "mm"};
    const std::string id = client::new_session_id();
    std::filesystem::path recorded = directory_ / "recorded" / id / "000001.recording";
    {
        RunningServer running(recorded_in(folder("recorded")));
        running.client.create_session(id, settings(), {.description = named});
        auto stream = running.client.stream(id);
        stream.push(frames()[0].view(), 0, 0.0);
        stream.finish();
        while (stream.next()) {
        }
        // Its file may still be on its way to the disk.
        std::vector<client::RecordingInfo> recordings;
        while (recordings.empty()) recordings = running.client.recordings();
        EXPECT_EQ(recordings.at(0).description.name, named.name);
        EXPECT_EQ(recordings.at(0).description.length_unit, "mm");
    }
    EXPECT_EQ(Recording(recorded).description().name, named.name);
    EXPECT_EQ(Recording(recorded).description().up_axis, client::UpAxis::z);
    const auto replayed_as = [&](std::vector<std::string> more) {
        const std::string session = client::new_session_id();
        {
            RunningServer other(recorded_in(folder("replayed")));
            std::vector<std::string> arguments{"replay",    recorded.string(), "--server", other.server.address(),
                                               "--session", session,           "--speed",  "max"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            EXPECT_EQ(meniscus(arguments), 0);
        }  // and its recording is whole
        return Recording(directory_ / "replayed" / session / "000001.recording").description();
    };
    EXPECT_EQ(replayed_as({}).name, named.name);
    EXPECT_EQ(replayed_as({}).length_unit, "mm");
    EXPECT_EQ(replayed_as({"--name", "again"}).name, "again");
    EXPECT_EQ(replayed_as({"--name", "again"}).up_axis, client::UpAxis::z);
}

TEST_F(RecordedSession, HasNoNameWhereTheFileHasOneThatNoSessionHas) {
    const auto file = record();
    v1::SessionDescription hostile;
    hostile.set_name("a\x1b[2J");
    const std::string id = client::new_session_id();
    const auto folder_of_it = file.parent_path().parent_path() / id;
    std::filesystem::create_directory(folder_of_it);
    std::ofstream(folder_of_it / "000001.recording", std::ios::binary)
        << recording_begin(id, settings(), 1, "", hostile);
    EXPECT_EQ(Recording(folder_of_it / "000001.recording").description().name, "");
    RunningServer running(recorded_in(file.parent_path().parent_path()));
    for (const client::RecordingInfo& recording : running.client.recordings())
        EXPECT_EQ(recording.description.name, "") << recording.session_id;
}

TEST_F(RecordedSession, ReplaysTheFramesThatAreAskedFor) {
    const auto recorded = record();
    const std::string session = client::new_session_id();
    {
        RunningServer other(recorded_in(folder("replayed")));
        ASSERT_EQ(meniscus({"replay", recorded.string(), "--server", other.server.address(), "--session", session,
                            "--speed", "max", "--from", "12", "--to", "16"}),
                  0);
    }
    const Recording part(directory_ / "replayed" / session / "000001.recording");
    ASSERT_EQ(part.frames().size(), 2U);
    EXPECT_EQ(part.frames()[0].index, index_of(1));
    EXPECT_EQ(part.frames()[1].index, index_of(2));
}

TEST_F(RecordedSession, LoopsUntilItsSessionIsGone) {
    const auto recorded = record();
    const std::string session = client::new_session_id();
    RunningServer other;
    std::thread deleting([&] {
        // Beyond the second round; the session comes with the replay.
        for (bool looped = false; !looped;)
            for (const client::SessionInfo& info : other.client.sessions()) looped |= info.frames > 2 * frames().size();
        other.client.delete_session(session);
    });
    EXPECT_NE(meniscus({"replay", recorded.string(), "--server", other.server.address(), "--session", session,
                        "--speed", "max", "--loop"}),
              0);
    deleting.join();
}

TEST_F(RecordedSession, BecomesFilesOfMeshesAndOfParticles) {
    const auto recorded = record();
    ASSERT_EQ(meniscus({"convert", recorded.string(), "-o", folder("meshes")}), 0);
    ASSERT_EQ(meniscus({"convert", recorded.string(), "-o", folder("bricks"), "--format", "bricks", "--to", "10"}), 0);
    ASSERT_EQ(meniscus({"convert", recorded.string(), "-o", folder("particles"), "--format", "vtk"}), 0);
    Reconstructor reconstructor(settings(), {.threads = 1});
    Mesh mesh;
    reconstructor.reconstruct(frames()[0].view(), mesh);
    EXPECT_EQ(formats::read_mesh(directory_ / "meshes" / "frame_000010.ply").triangles.size(), mesh.triangles.size());
    EXPECT_EQ(formats::read_mesh(directory_ / "bricks" / "frame_000010.bricks").triangles.size(),
              mesh.triangles.size());
    EXPECT_FALSE(std::filesystem::exists(directory_ / "bricks" / "frame_000013.bricks"));
    for (const std::size_t i : {0U, 2U, 3U, 4U}) {
        const auto particles =
            formats::read_particles(directory_ / "particles" / ("frame_0000" + std::to_string(index_of(i)) + ".vtk"));
        EXPECT_EQ(particles.positions, frames()[i].positions);
        EXPECT_EQ(particles.levels, frames()[i].levels);
    }
    const auto decoded = formats::read_particles(directory_ / "particles" / "frame_000013.vtk").positions;
    ASSERT_EQ(decoded.size(), frames()[1].quantized.size());
    for (std::size_t i = 0; i < decoded.size(); ++i) EXPECT_NEAR(decoded[i], wave(8, 1.0).positions[i], 10.0 / 65535.0);
}

TEST_F(RecordedSession, IsListedBesideADamagedOne) {
    const auto recorded = record();
    std::filesystem::create_directory(directory_ / "recorded" / "damaged");
    std::filesystem::copy_file(recorded, directory_ / "recorded" / "damaged" / "000001.recording");
    std::filesystem::resize_file(directory_ / "recorded" / "damaged" / "000001.recording", 10);
    std::filesystem::resize_file(recorded, std::filesystem::file_size(recorded) - 1);
    testing::internal::CaptureStdout();
    EXPECT_EQ(meniscus({"recordings", folder("recorded"), "--json"}), 0);
    const std::string json = testing::internal::GetCapturedStdout();
    for (const char* words : {"\"first_index\": 10", "\"last_index\": 22", "\"frames\": 5", "\"meshes\": 4",
                              "\"particle_radius\": 0.1", "not a recording"})
        EXPECT_NE(json.find(words), std::string::npos) << words << "\n" << json;
    EXPECT_EQ(json.find("\"cut_bytes\": 0"), std::string::npos);
    testing::internal::CaptureStdout();
    EXPECT_EQ(meniscus({"recordings", folder("recorded")}), 0);
    EXPECT_NE(testing::internal::GetCapturedStdout().find("5 frames (10 to 22), 4 meshes"), std::string::npos);
}

TEST_F(RecordedSession, IsNeitherReplayedNorConvertedWhereItIsDamagedAndIsListedWithTheFramesThatAre) {
    const auto recorded = record();
    const auto flip = [&](const files::RecordedRange& range) {
        std::fstream bytes(recorded, std::ios::binary | std::ios::in | std::ios::out);
        bytes.seekp(static_cast<std::streamoff>(range.first + range.size / 2));
        bytes << "\x11\x22\x33\x44";
    };
    const auto frames = Recording(recorded).frames();
    flip(frames[1].particles);
    flip(*frames[4].mesh);
    testing::internal::CaptureStdout();
    EXPECT_EQ(meniscus({"recordings", folder("recorded")}), 0);
    std::string said = testing::internal::GetCapturedStdout();
    EXPECT_NE(said.find("; damaged: frames [13,22]"), std::string::npos) << said;
    testing::internal::CaptureStdout();
    EXPECT_EQ(meniscus({"recordings", folder("recorded"), "--quick"}), 0);
    said = testing::internal::GetCapturedStdout();
    EXPECT_EQ(said.find("damaged"), std::string::npos) << said;
    const auto error_of = [](const std::vector<std::string>& arguments) {
        testing::internal::CaptureStderr();
        EXPECT_EQ(meniscus(arguments), 2);
        return testing::internal::GetCapturedStderr();
    };
    said = error_of({"convert", recorded.string(), "-o", folder("meshes"), "--from", "22"});
    EXPECT_EQ(said, "meniscus: " + recorded.string() +
                        ": mesh of frame 22: it does not have its checksum: the file is damaged\n");
    RunningServer other;
    said = error_of({"replay", recorded.string(), "--server", other.server.address(), "--from", "13", "--to", "13"});
    EXPECT_NE(said.find(recorded.string() + ": particles of frame 13: they do not have their checksum"),
              std::string::npos)
        << said;
}

TEST_F(RecordedSession, OfBeforeChecksumsIsConvertedOrRefusedInALineThatNamesFileAndFrame) {
    const auto damaged = directory_ / "damaged.recording";
    const auto path = std::filesystem::path(MENISCUS_GOLDEN_FILES) / "version_2.recording";
    const std::string bytes = formats::read_file(path);
    const files::RecordedRange mesh = *Recording(path).frames()[1].mesh;
    int refused = 0;
    for (std::uint64_t i = 0; i < mesh.size; ++i) {
        std::string changed = bytes;
        changed[mesh.first + i] = static_cast<char>(~changed[mesh.first + i]);
        std::ofstream(damaged, std::ios::binary) << changed;
        testing::internal::CaptureStderr();
        const int code = meniscus({"convert", damaged.string(), "-o", folder("meshes"), "--from", "1"});
        const std::string said = testing::internal::GetCapturedStderr();
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
        if (code == 0) continue;
        ++refused;
        EXPECT_TRUE(said.starts_with("meniscus: " + damaged.string() + ": ")) << said;
        EXPECT_NE(said.find("frame 1"), std::string::npos) << said;
    }
    EXPECT_GT(refused, 100);
}

TEST_F(RecordedSession, OfTwoStreamsWithTheSameIndicesIsTwoRecordings) {
    std::string id;
    {
        RunningServer running(recorded_in(folder("recorded")));
        id = running.session();
        for (int i = 0; i < 2; ++i) {
            auto stream = running.client.stream(id);
            stream.push(wave(6, i).view(), 0, 0.0);
            stream.finish();
            while (stream.next()) {
            }
        }
    }
    for (int i = 0; i < 2; ++i) {
        const Recording recording(directory_ / "recorded" / id / ("00000" + std::to_string(i + 1) + ".recording"));
        ASSERT_EQ(recording.frames().size(), 1U);
        EXPECT_EQ(mesh_sha256(recording.mesh(recording.frames()[0]).mesh()), local_sha256(wave(6, i)));
    }
    EXPECT_NE(meniscus({"convert", (directory_ / "recorded" / id).string(), "-o", folder("meshes")}), 0);
}

std::vector<std::uint64_t> indices(const std::filesystem::path& recording) {
    const Recording opened(recording);
    std::vector<std::uint64_t> indices;
    for (const formats::RecordedFrame& frame : opened.frames()) indices.push_back(frame.index);
    return indices;
}

TEST_F(RecordedSession, DoesNotHoldFramesThatThePolicyDropped) {
    std::string id;
    {
        RunningServer running(recorded_in(folder("recorded")));
        id = running.session();
        auto stream = running.client.stream(id, {.policy = client::UploadPolicy::every_nth, .nth = 3});
        for (std::uint64_t i = 0; i < 8; ++i) stream.push(wave(6, 0.0).view(), i, 0.0);
        stream.finish();
        while (stream.next()) {
        }
    }
    EXPECT_EQ(indices(directory_ / "recorded" / id / "000001.recording"), (std::vector<std::uint64_t>{0, 3, 6}));
}

TEST_F(RecordedSession, HoldsTheFramesOfARunThatWasResumedOnce) {
    std::string id;
    {
        RunningServer running(recorded_in(folder("recorded")));
        id = running.session();
        for (const std::uint64_t frames : {2, 4}) {
            RawStream stream(running.server.address(), id, false);
            v1::StreamRequest open;
            open.mutable_open()->set_session_id(id);
            open.mutable_open()->set_run_id(7);
            stream.call->Write(open);
            for (std::uint64_t i = 0; i < frames; ++i) {
                stream.send_begin(i, 0);
                stream.send_end();
            }
            stream.call->WritesDone();
            EXPECT_TRUE(stream.finish().ok());
            EXPECT_EQ(stream.answered, static_cast<int>(frames));
        }
    }
    EXPECT_EQ(indices(directory_ / "recorded" / id / "000001.recording"), (std::vector<std::uint64_t>{0, 1, 2, 3}));
    EXPECT_FALSE(std::filesystem::exists(directory_ / "recorded" / id / "000002.recording"));
}

TEST_F(RecordedSession, GoesOnPastTheLimit) {
    ServerOptions options = recorded_in(folder("recorded"));
    options.recording.limit = 10'000;
    options.http = "127.0.0.1:0";
    RunningServer running(options);
    auto stream = running.client.stream(running.session());
    for (std::uint64_t i = 0; i < 8; ++i) {
        stream.push(wave(8, 0.0).view(), i, 0.0);
        ASSERT_EQ(mesh_sha256(stream.next()->mesh()), local_sha256(wave(8, 0.0)));
    }
    while (running.server.recordings()->counters().stopped == 0) {
    }
    EXPECT_LE(running.server.recordings()->counters().bytes, options.recording.limit);
    const Samples samples = scrape_until(running.server.http_address(), "meniscus_recordings_stopped_total", 1);
    EXPECT_EQ(samples.at("meniscus_recorded_frames_total"), 1);
    EXPECT_EQ(samples.at("meniscus_recorded_bytes_total"),
              static_cast<double>(running.server.recordings()->counters().bytes));
}

TEST_F(RecordedSession, DoesNotHoldFramesThatCouldNotBeUsed) {
    std::string id;
    {
        RunningServer running(recorded_in(folder("recorded")));
        id = running.session();
        auto stream = running.client.stream(id);
        stream.push(wave(6, 0.0).view(), 0, 0.0);
        Particles bad = wave(6, 0.0);
        bad.positions[0] = std::numeric_limits<float>::quiet_NaN();
        EXPECT_THROW(
            {
                stream.push(bad.view(), 1, 0.0);
                while (stream.next()) {
                }
            },
            InvalidInput);
    }
    EXPECT_EQ(Recording(directory_ / "recorded" / id / "000001.recording").frames().size(), 1U);
}

TEST(ReplayPace, IsNoFasterThanAskedFor) {
    const auto start = std::chrono::steady_clock::now();
    cli::ReplayPace pace("4");
    pace.wait(std::chrono::milliseconds(0));
    pace.wait(std::chrono::milliseconds(400));
    EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(100));
    cli::ReplayPace("max").wait(std::chrono::hours(24 * 365));
}

TEST(ReplayPace, RefusesWhatIsNoSpeed) {
    for (const char* speed : {"", "0", "-1", "nan", "inf", "2x", "fast"})
        EXPECT_THROW(cli::ReplayPace{speed}, InvalidInput) << speed;
}

}  // namespace
}  // namespace meniscus::server::test
