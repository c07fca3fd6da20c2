// meniscus push: finished bricks through a pipe are those of a publisher.
#include <array>
#include <cstddef>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "meniscus/mesh_hash.hpp"
#include "own_surfaces.hpp"
#include "push_fixture.hpp"

namespace meniscus::test {
namespace {

class PushBricks : public Push {
protected:
    PushBricks() {
        settings_.all_attributes = true;
        client_.create_session(id_, settings_);
    }
    std::vector<std::string> flags(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"-r", "0.1", "--attribute", "all", "--session", id_, "-q"});
        return more;
    }
    client::ReceivedFrame shown(const std::string& id) {
        return client_.snapshot(id, {.attributes = {{.name = {}, .bits = 0}}}).value();
    }

    std::string id_ = client::new_session_id();
};

TEST_F(PushBricks, GivesTheMeshesAttributesAndFiguresOfADirectPublication) {
    const Block block(24);
    for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy}) {
        const client::ReceivedFrame frame = surface_of(settings_, block.frame(), 7, codec);
        const std::string direct = client::new_session_id();
        client_.create_session(direct, settings_);
        client::Publisher publisher = client_.publish(direct);
        publisher.push(frame);
        ASSERT_TRUE(publisher.next());
        const ProcessResult result = push(pushing::bricks_beginning() + bytes_of(frame), flags());
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const client::ReceivedFrame there = shown(direct);
        const client::ReceivedFrame here = shown(id_);
        EXPECT_EQ(here.index, 7U);
        EXPECT_EQ(here.simulation_time, 3.5);
        EXPECT_EQ(mesh_sha256(here.mesh()), mesh_sha256(there.mesh()));
        EXPECT_EQ(bricks_sha256(here.mesh()), bricks_sha256(there.mesh()));
        for (std::size_t a = 0; a < 2; ++a) EXPECT_EQ(here.mesh().attributes[a].data, there.mesh().attributes[a].data);
        EXPECT_EQ(here.statistics.particles, block.positions.size() / 3);
        EXPECT_EQ(here.statistics.volume, there.statistics.volume);
        EXPECT_EQ(here.statistics.field_evaluations, there.statistics.field_evaluations);
        const auto lines = lines_of(result);
        ASSERT_EQ(lines.size(), 3U) << result.out;
        EXPECT_EQ(lines[0].at("session"), id_);
        EXPECT_EQ(lines[1].at("frame"), 7);
        EXPECT_EQ(lines[1].at("triangles"), there.statistics.triangles);
        EXPECT_EQ(lines[2], nlohmann::json({{"ended", true}, {"dropped", 0}}));
        client_.delete_session(id_);
        client_.create_session(id_, settings_);
    }
}

TEST_F(PushBricks, NumbersTheFilesOfASequence) {
    std::string files;
    for (const unsigned side : {3U, 5U}) {
        const Block block(side);
        files += pushing::bricks_beginning() + bytes_of(surface_of(settings_, block.frame(), 0));
    }
    const ProcessResult result = push(files, flags());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto lines = lines_of(result);
    ASSERT_EQ(lines.size(), 4U) << result.out;
    EXPECT_EQ(lines[1].at("frame"), 0);
    EXPECT_EQ(lines[2].at("frame"), 1);
    const Block last(5);
    EXPECT_EQ(mesh_sha256(shown(id_).mesh()), mesh_sha256(surface_of(settings_, last.frame(), 1).mesh()));
}

TEST_F(PushBricks, OfOneFrameComeFromSeveralProcesses) {
    constexpr std::size_t parts = 3;
    const Block block(24);
    const client::ReceivedFrame whole = surface_of(settings_, block.frame(), 2);
    ASSERT_GT(whole.bricks.size(), parts);
    std::array<std::thread, parts> processes;
    std::array<ProcessResult, parts> results;
    for (std::size_t p = 0; p < parts; ++p) {
        client::ReceivedFrame part = whole;
        part.bricks.clear();
        if (p != 0) static_cast<Statistics&>(part.statistics) = {};
        part.statistics.triangles = 0;
        part.statistics.vertices = 0;  // of which the bricks do not say whose they are
        for (std::size_t b = p; b < whole.bricks.size(); b += parts) {
            part.bricks.push_back(whole.bricks[b]);
            part.statistics.triangles += whole.bricks[b]->triangles;
        }
        const std::string file = (directory_ / ("part" + std::to_string(p))).string();
        formats::write_file(file, pushing::bricks_beginning() + bytes_of(part));
        std::vector<std::string> words =
            flags({"--parts", std::to_string(parts), "--part", std::to_string(p), "--run", "99"});
        words.insert(words.begin(), {"push", file, "--server", server_.address(), "--answers", "-"});
        processes[p] = std::thread([&results, p, words] { results[p] = run_process(MENISCUS_CLI, words); });
    }
    for (std::thread& process : processes) process.join();
    for (const ProcessResult& result : results) {
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const auto lines = lines_of(result);
        ASSERT_EQ(lines.size(), 3U) << result.out;
        EXPECT_EQ(lines[1].at("triangles"), whole.statistics.triangles);
        EXPECT_EQ(lines[1].at("particles"), whole.statistics.particles);
    }
    EXPECT_EQ(mesh_sha256(shown(id_).mesh()), mesh_sha256(whole.mesh()));
}

TEST_F(PushBricks, OfParticlesComeFromSeveralProcessesToo) {
    client_.delete_session(id_);
    Settings settings = settings_;
    settings.all_attributes = false;
    client_.create_session(id_, settings);
    const Block whole(6);
    const std::string file = (directory_ / "none").string();
    Block none(1);
    none.positions.clear();
    none.arrays.clear();
    const auto pieces_of = [](const ParticleFrame& frame) {
        std::string out = pushing::recording_beginning();
        for (const pushing::FramePiece& piece : pushing::frame_pieces(frame, 3, 0.0))
            out.append(piece.head).append(reinterpret_cast<const char*>(piece.data.data()), piece.data.size());
        return out;
    };
    formats::write_file(file, pieces_of(none.frame()));
    const std::vector<std::string> common{"--server", server_.address(), "-r", "0.1",   "-q", "--session",
                                          id_,        "--parts",         "2",  "--run", "5",  "--keep-session"};
    std::vector<std::string> words = common;
    words.insert(words.begin(), {"push", file, "--part", "1"});
    ProcessResult second;
    std::thread process([&] { second = run_process(MENISCUS_CLI, words); });
    std::vector<std::string> first_flags(common.begin() + 2, common.end());
    const ProcessResult first = push(pieces_of(whole.frame()), first_flags);
    process.join();
    EXPECT_EQ(first.exit_code, 0) << first.err;
    EXPECT_EQ(second.exit_code, 0) << second.err;
    EXPECT_EQ(mesh_sha256(client_.snapshot(id_).value().mesh()),
              mesh_sha256(surface_of(settings, whole.frame(), 3).mesh()));
}

TEST_F(PushBricks, AnswersTheFramesBeforeABrokenOneAndThenSaysWhatIsWrong) {
    const Block block(3);
    const std::string whole = pushing::bricks_beginning() + bytes_of(surface_of(settings_, block.frame(), 0));
    const std::string cut = whole + bytes_of(surface_of(settings_, block.frame(), 1)).substr(0, 300);
    for (const auto& [bytes, words] : std::vector<std::pair<std::string, std::string>>{
             {cut,
              "it ends at byte " + std::to_string(cut.size()) + ", within frame 1: whatever writes it ended early"},
             {whole + pushing::recording_beginning(), "a recording behind bricks"}}) {
        const ProcessResult result = push(bytes, flags());
        EXPECT_EQ(result.exit_code, 2);
        const auto lines = lines_of(result);
        ASSERT_EQ(lines.size(), 3U) << result.out;
        EXPECT_EQ(lines[1].at("frame"), 0);
        EXPECT_EQ(lines[2].at("code"), "invalid_input");
        EXPECT_NE(lines[2].at("error").get<std::string>().find(words), std::string::npos) << result.out;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        client_.delete_session(id_);
        client_.create_session(id_, settings_);
    }
}

TEST_F(PushBricks, SaysWhyTheServerRefusesThem) {
    const Block block(3);
    const ProcessResult coarse = push(pushing::bricks_beginning() + bytes_of(surface_of(settings_, block.frame(), 0)),
                                      {"-r", "0.1", "--cell-size", "1", "--attribute", "all", "-q"});
    EXPECT_EQ(coarse.exit_code, 2);
    EXPECT_NE(coarse.err.find("frame 0: cell_size is 0.05, and 0.1 with the session's settings"), std::string::npos)
        << coarse.err;
    const ProcessResult none = push(pushing::bricks_beginning() + bytes_of(surface_of(settings_, block.frame(), 0)));
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_NE(none.err.find("its beginning has no settings: give --particle-radius"), std::string::npos) << none.err;
}

TEST_F(PushBricks, SaysThatThereIsNoServer) {
    const Block block(2);
    const std::string file = (directory_ / "bricks").string();
    formats::write_file(file, pushing::bricks_beginning() + bytes_of(surface_of(settings_, block.frame(), 0)));
    const ProcessResult result = run_process(
        MENISCUS_CLI, {"push", file, "--server", "unix:/nowhere/meniscus", "-r", "0.1", "-q", "--answers", "-"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("no server at unix:/nowhere/meniscus"), std::string::npos) << result.err;
    ASSERT_EQ(lines_of(result).size(), 1U);
    EXPECT_EQ(lines_of(result)[0].at("code"), "unavailable");
}

}  // namespace
}  // namespace meniscus::test
