// A mesh that came through a server is, to the byte, the file that a local run writes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/server.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

/// A block of water with drops flying off it, larger than a brick, and a server that records.
class SameFiles : public testing::Test {
protected:
    SameFiles() {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> jitter(-0.2F, 0.2F);
        const auto add = [&](float x, float y, float z) {
            for (const float coordinate : {x, y, z}) positions.push_back(coordinate + jitter(random));
        };
        for (int z = 0; z < 10; ++z)
            for (int y = 0; y < 10; ++y)
                for (int x = 0; x < 10; ++x) add(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        for (int i = 0; i < 10; ++i) add(static_cast<float>(i), 14.0F + 3.0F * static_cast<float>(i % 2), 5.0F);
        std::string bytes;
        for (const float x : positions) formats::store(bytes, x);
        formats::write_file(in(), bytes);
    }

    std::string path(const std::string& name) const { return (directory / name).string(); }
    std::string in() const { return path("particles.xyz"); }
    std::string bytes_of(const std::string& name) const { return formats::read_file(directory / name); }

    void reconstruct(std::vector<std::string> more) const {
        more.insert(more.begin(), {"reconstruct", in(), "--particle-radius", "0.5", "--quiet"});
        const ProcessResult result = run_process(MENISCUS_CLI, more);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }

    /// Local, and through the server.
    void expect_same_file(const std::string& extension, const std::vector<std::string>& flags) const {
        std::string all;
        for (const std::string& flag : flags) all += flag + " ";
        SCOPED_TRACE(extension + " " + all);
        std::vector<std::string> here = flags;
        here.insert(here.end(), {"-o", path("here" + extension)});
        std::vector<std::string> there = flags;
        there.insert(there.end(), {"-o", path("there" + extension), "--server", server->address()});
        reconstruct(here);
        reconstruct(there);
        EXPECT_TRUE(bytes_of("here" + extension) == bytes_of("there" + extension));
    }

    server::ServerOptions options() const {
        server::ServerOptions options;
        options.listen = "unix:" + path("socket");
        options.backend.threads = 2;
        options.recording.directory = path("recorded");
        return options;
    }

    TemporaryDirectory directory;
    std::vector<float> positions;
    std::optional<server::Server> server{std::in_place, options()};
};

TEST_F(SameFiles, ComeFromAServerAndFromALocalRun) {
    for (const char* bits : {"0", "2", "7", "16"}) expect_same_file(".ply", {"--normal-bits", bits});
    expect_same_file(".obj", {"--normal-bits", "8"});
    expect_same_file(".obj", {"--normal-bits", "11", "--mode", "uniform", "--cell-size", "1"});
    expect_same_file(".ply", {"--no-normals"});
    expect_same_file(".ply", {"--no-normals", "--mode", "uniform", "--cell-size", "1"});
    expect_same_file(".ply", {"--normal-bits", "5", "--field", "density", "--criterion", "count"});
    expect_same_file(".ply", {"--normal-bits", "12", "--field", "color", "--domain", "1", "1", "1", "6", "7", "8"});
    expect_same_file(".ply", {"--normal-bits", "9", "--positions", "uint16"});
    expect_same_file(".ply", {"--normals-by", "receiver"});
    expect_same_file(".ply", {"--normals-by", "receiver", "--no-normals", "--mode", "uniform", "--cell-size", "1"});
}

/// Particles with a velocity and a number each, as PLY.
std::string ply_with_arrays(const std::vector<float>& positions) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(positions.size() / 3) +
                       "\nproperty float x\nproperty float y\nproperty float z\nproperty float speed\nproperty int "
                       "number\nend_header\n";
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        for (std::size_t c = 0; c < 3; ++c) text += std::to_string(positions[i + c]) + ' ';
        text += std::to_string(std::sin(positions[i])) + ' ' + std::to_string(i) + '\n';
    }
    return text;
}

TEST_F(SameFiles, HaveTheSameAttributesForTheSameBits) {
    formats::write_file(path("particles.ply"), ply_with_arrays(positions));
    const auto write = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(),
                         {"reconstruct", path("particles.ply"), "--particle-radius", "0.5", "--quiet", "--attribute",
                          "speed", "--attribute", "number", "--normal-bits", "8"});
        const ProcessResult result = run_process(MENISCUS_CLI, arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    };
    write({"-o", path("default.ply")});
    for (const char* bits : {"0", "3", "8", "16"}) {
        SCOPED_TRACE(bits);
        write({"-o", path("here.ply"), "--attribute-bits", bits});
        write({"-o", path("there.ply"), "--attribute-bits", bits, "--server", server->address()});
        EXPECT_TRUE(bytes_of("here.ply") == bytes_of("there.ply"));
        EXPECT_EQ(bytes_of("here.ply") == bytes_of("default.ply"), bits == std::string_view("0"));
        EXPECT_NE(bytes_of("here.ply").find("speed"), std::string::npos);
    }
}

TEST_F(SameFiles, ComeWithTheSameSpray) {
    for (const char* where : {"here", "there"}) {
        std::vector<std::string> arguments{"-o",
                                           path(std::string(where) + ".ply"),
                                           "--spray-out",
                                           path(std::string(where) + "_spray.ply"),
                                           "--spray",
                                           "points",
                                           "--normal-bits",
                                           "8"};
        if (where == std::string_view("there")) arguments.insert(arguments.end(), {"--server", server->address()});
        reconstruct(arguments);
    }
    EXPECT_TRUE(bytes_of("here.ply") == bytes_of("there.ply"));
    EXPECT_TRUE(bytes_of("here_spray.ply") == bytes_of("there_spray.ply"));
    EXPECT_GT(bytes_of("here_spray.ply").size(), 200U);
}

TEST_F(SameFiles, ComeFromWatchersAndFromRecordings) {
    client::Client client(server->address());
    Settings settings;
    settings.particle_radius = 0.5;
    const std::string id = client::new_session_id();
    client.create_session(id, settings);
    auto stream = client.stream(id);
    ParticleFrame frame;
    frame.positions = positions;
    stream.push(frame, 0, 0.0);
    ASSERT_TRUE(stream.next());
    const ProcessResult watched =
        run_process(MENISCUS_CLI, {"watch", id, "--server", server->address(), "-o", path("watched"), "--frames", "1",
                                   "--normal-bits", "10", "--quiet"});
    ASSERT_EQ(watched.exit_code, 0) << watched.err;
    EXPECT_EQ(watched.err, "");
    stream.finish();
    ASSERT_FALSE(stream.next());
    client.delete_session(id);
    reconstruct({"--normal-bits", "10", "-o", path("10.ply")});
    EXPECT_TRUE(bytes_of("watched/frame_000000.ply") == bytes_of("10.ply"));

    server.reset();  // and the recording is whole
    const std::string recorded = path("recorded/" + id);
    const ProcessResult converted =
        run_process(MENISCUS_CLI, {"convert", recorded, "-o", path("converted"), "--quiet"});
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
    EXPECT_EQ(converted.err, "");
    reconstruct({"--normal-bits", "8", "-o", path("8.ply")});
    EXPECT_TRUE(bytes_of("converted/frame_000000.ply") == bytes_of("8.ply"));
    const ProcessResult piped = run_process(MENISCUS_CLI, {"convert", recorded, "-o", "-"});
    EXPECT_TRUE(piped.out == bytes_of("8.ply"));
    EXPECT_EQ(piped.err, "standard output\n");
}

TEST_F(SameFiles, OfALocalRunKeepNormalsUnroundedUnlessTold) {
    reconstruct({"-o", path("unrounded.ply")});
    reconstruct({"-o", path("rounded.ply"), "--normal-bits", "16"});
    EXPECT_EQ(bytes_of("unrounded.ply").size(), bytes_of("rounded.ply").size());
    EXPECT_FALSE(bytes_of("unrounded.ply") == bytes_of("rounded.ply"));
}

}  // namespace
}  // namespace meniscus::test
