// meniscus push: frames through a pipe are those of an upload, and what is wrong with them is said.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "formats/bytes/byte_cursor.hpp"
#include "meniscus/mesh_hash.hpp"
#include "push_fixture.hpp"
#include "pushing/frame_bytes.hpp"

namespace meniscus::test {
namespace {

std::string bytes_of(const Block& block, std::uint64_t index) {
    std::string out;
    for (const pushing::FramePiece& piece :
         pushing::frame_pieces(block.frame(), index, 0.5 * static_cast<double>(index)))
        out.append(piece.head).append(reinterpret_cast<const char*>(piece.data.data()), piece.data.size());
    return out;
}

TEST_F(Push, GivesTheMeshesAndAttributesOfTheSameFramesUploaded) {
    settings_.attributes = {"id", "speed"};
    for (const unsigned side : {2U, 5U, 50U}) {  // the last one is more than a chunk
        const Block block(side);
        const std::string uploaded = client::new_session_id();
        client_.create_session(uploaded, settings_);
        client::Stream stream = client_.stream(uploaded);
        stream.push(block.frame(), 7, 3.5);
        stream.finish();
        while (stream.next()) {
        }
        const std::string pushed = client::new_session_id();
        client_.create_session(pushed, settings_);
        const ProcessResult result =
            push(pushing::recording_beginning() + bytes_of(block, 7),
                 {"--session", pushed, "-r", "0.1", "--attribute", "id", "--attribute", "speed"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const client::SnapshotOptions all{.attributes = {{.name = {}, .bits = 0}}};
        const client::ReceivedFrame there = client_.snapshot(uploaded, all).value();
        const client::ReceivedFrame here = client_.snapshot(pushed, all).value();
        EXPECT_EQ(here.index, 7U);
        EXPECT_EQ(here.simulation_time, 3.5);
        EXPECT_EQ(mesh_sha256(here.mesh()), mesh_sha256(there.mesh()));
        ASSERT_EQ(here.mesh().attributes.size(), 2U);
        for (std::size_t a = 0; a < 2; ++a) EXPECT_EQ(here.mesh().attributes[a].data, there.mesh().attributes[a].data);
        client_.delete_session(uploaded);
        client_.delete_session(pushed);
    }
}

TEST_F(Push, AnswersEachFrameByALineOfJson) {
    const ProcessResult result =
        push(pushing::recording_beginning() + bytes_of(Block(3), 2) + bytes_of(Block(4), 9), {"-r", "0.1", "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const auto lines = lines_of(result);
    ASSERT_EQ(lines.size(), 4U) << result.out;
    EXPECT_EQ(lines[0].at("session").get<std::string>().size(), 36U);
    EXPECT_EQ(lines[1].at("frame"), 2);
    EXPECT_EQ(lines[1].at("particles"), 27);
    EXPECT_EQ(lines[2].at("frame"), 9);
    EXPECT_EQ(lines[2].at("simulation_time"), 4.5);
    EXPECT_GT(lines[2].at("triangles"), 0);
    EXPECT_EQ(lines[3], nlohmann::json({{"ended", true}, {"dropped", 0}}));
}

TEST_F(Push, AnswersTheFramesBeforeABrokenOneAndThenSaysWhatIsWrong) {
    const std::string whole = pushing::recording_beginning() + bytes_of(Block(3), 0) + bytes_of(Block(3), 1);
    const std::string cut = whole + bytes_of(Block(3), 2).substr(0, 100);
    const ProcessResult result = push(cut, {"-r", "0.1", "-q"});
    EXPECT_EQ(result.exit_code, 2);
    const auto lines = lines_of(result);
    ASSERT_EQ(lines.size(), 4U) << result.out;
    EXPECT_EQ(lines[2].at("frame"), 1);
    const std::string said = "standard input: it ends at byte " + std::to_string(cut.size()) +
                             ", within frame 2: whatever writes it ended early";
    EXPECT_EQ(lines[3].at("error"), said);
    EXPECT_EQ(lines[3].at("code"), "invalid_input");
    EXPECT_EQ(result.err, "meniscus: " + said + "\n");
}

TEST_F(Push, RefusesARecordedFrameThatCameAsFinishedBricks) {
    server::ServerOptions options;
    options.listen = "unix:" + (directory_ / "recording-socket").string();
    options.recording.directory = directory_ / "recordings";
    const std::string id = client::new_session_id();
    {
        server::Server recording(options);
        client::Client client(recording.address());
        client.create_session(id, settings_);
        Reconstructor reconstructor(settings_, {.backend = Backend::cpu, .threads = 1, .keep_lattice = true});
        Mesh mesh;
        reconstructor.reconstruct(Block(4).frame(), mesh);
        client::Publisher publisher = client.publish(id);
        publisher.push(
            client::encode_frame(mesh, reconstructor.statistics(), 6, 0.5, {.codec = Codec::lattice_packed}));
        publisher.finish();
        ASSERT_TRUE(publisher.next());
        client.delete_session(id);
    }
    const auto file = std::filesystem::directory_iterator(directory_ / "recordings" / id)->path();
    const ProcessResult result = push(formats::read_file(file), {"-q"});
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_NE(result.err.find("frame 6 came as finished bricks: it has a mesh, which convert writes, and no particles"),
              std::string::npos)
        << result.err;
}

TEST_F(Push, TakesSettingsFromTheFlagsOrFromTheRecordingAndNeverFromBoth) {
    const std::string bytes = pushing::recording_beginning() + bytes_of(Block(2), 0);
    const ProcessResult none = push(bytes);
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_NE(none.err.find("its beginning has no settings: give --particle-radius"), std::string::npos) << none.err;
    const ProcessResult half = push(bytes, {"--cell-size", "1"});
    EXPECT_EQ(half.exit_code, 2);
    EXPECT_NE(half.err.find("give --particle-radius, too"), std::string::npos) << half.err;
}

TEST_F(Push, EndsWithItsSessionThoughItsPipeGoesOn) {
    const std::string pipe = (directory_ / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const int both = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);
    const std::string bytes = pushing::recording_beginning() + bytes_of(Block(2), 0);
    ASSERT_EQ(::write(both, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    const std::string id = client::new_session_id();
    client_.create_session(id, settings_);
    std::thread ending([&] {
        client::Watcher watcher = client_.watch(id);
        EXPECT_TRUE(watcher.next());
        client_.delete_session(id);
    });
    const ProcessResult result = run_process(MENISCUS_CLI, {"push", pipe, "--server", server_.address(), "--session",
                                                            id, "-r", "0.1", "--reconnect", "0", "-q"});
    ending.join();
    ::close(both);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("meniscus: "), std::string::npos) << result.err;
}

}  // namespace
}  // namespace meniscus::test
