// meniscus reconstruct on sequences: several frames at a time, the bar, runs that were interrupted.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli_fixture.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/recordings/brick_file.hpp"
#include "terminal_program.hpp"

namespace meniscus::test {
namespace {

class Sequences : public Cli {
protected:
    static constexpr int frame_count = 12;

    /// Every frame has a particle more than the one before.
    Sequences() {
        for (int i = 0; i < frame_count; ++i)
            write(frame_name(i), particles(positions_.size() - 3 * (frame_count - i)));
    }

    static std::string number(int i) { return (i < 10 ? "0" : "") + std::to_string(i); }
    static std::string frame_name(int i) { return "f_" + number(i) + ".xyz"; }
    std::string particles(std::size_t values) const {
        std::string bytes;
        for (std::size_t i = 0; i < values; ++i) formats::store(bytes, positions_[i]);
        return bytes;
    }
    std::vector<std::string> sequence(const std::string& folder, std::vector<std::string> more) const {
        std::filesystem::create_directory(path(folder));
        more.insert(more.begin(), {"reconstruct", path("f_{}.xyz"), "-o", path(folder + "/m_{}.ply"), "-r", "0.5", "-c",
                                   "1", "--backend", "cpu"});
        return more;
    }
    std::string mesh(const std::string& folder, int i) const { return path(folder + "/m_" + number(i) + ".ply"); }
    void expect_same_meshes(const std::string& a, const std::string& b) const {
        for (int i = 0; i < frame_count; ++i)
            EXPECT_TRUE(formats::read_file(mesh(a, i)) == formats::read_file(mesh(b, i))) << i;
    }
};

TEST_F(Sequences, AreTheSameForAnyNumberOfFramesAtATime) {
    std::array<std::string, 3> said;
    std::array<nlohmann::json, 3> figures;
    for (const std::size_t jobs : {1, 4}) {
        const std::string name = std::to_string(jobs);
        const ProcessResult result = run_meniscus(
            sequence(name, {"--jobs", name, "--threads", "4", "--stats", path("s.json"), "--preset", "splashsurf"}));
        ASSERT_EQ(result.exit_code, 0) << result.err;
        std::string& text = said[jobs / 2];
        for (std::size_t at = 0, end; (end = result.err.find('\n', at)) != std::string::npos; at = end + 1)
            text += result.err.substr(at, result.err.find(',', at) - at) + '\n';  // names and particles, no times
        nlohmann::json all = nlohmann::json::parse(formats::read_file(path("s.json"))).at("frames");
        for (nlohmann::json& frame : all) figures[jobs / 2].push_back({frame["frame"], frame["mesh_sha256"]});
    }
    expect_same_meshes("1", "4");
    EXPECT_EQ(said[0], said[2]);
    EXPECT_EQ(figures[0], figures[2]);
    EXPECT_EQ(figures[0].size(), std::size_t{frame_count});
    EXPECT_EQ(figures[0][3][0], 3);
}

TEST_F(Sequences, HaveTheTimesOfTheirNumbersByTheirFrameRate) {
    const auto times_at = [&](const std::vector<std::string>& rate) {
        std::vector<std::string> command{"reconstruct",
                                         path("f_{}.xyz"),
                                         "-o",
                                         path("m_{}.bricks"),
                                         "-r",
                                         "0.5",
                                         "-c",
                                         "1",
                                         "-q",
                                         "--start",
                                         "4",
                                         "--end",
                                         "7",
                                         "--step",
                                         "3"};
        command.insert(command.end(), rate.begin(), rate.end());
        EXPECT_EQ(run_meniscus(command).exit_code, 0);
        std::vector<double> times;
        for (const char* name : {"m_04.bricks", "m_07.bricks"})
            times.push_back(formats::read_bricks(name, formats::read_file(path(name))).simulation_time);
        return times;
    };
    EXPECT_EQ(times_at({"--frame-rate", "8"}), (std::vector<double>{0.5, 0.875}));
    EXPECT_EQ(times_at({}), (std::vector<double>{0.0, 0.0}));
    expect_refused({"reconstruct", path(frame_name(0)), "-o", out_, "-r", "0.5", "--frame-rate", "8"},
                   {"--frame-rate", "needs {} in IN"});
    for (const char* wrong : {"0", "-1", "nan", "2000000"})
        expect_refused(sequence("wrong", {"--frame-rate", wrong}), {"--frame-rate", wrong});
}

TEST_F(Sequences, EndAtABadFrameWhichIsNamedWithAllBeforeItWhole) {
    write(frame_name(5), "not twelve");
    write(frame_name(7), "nor this");
    for (const char* jobs : {"1", "4"}) {
        const std::string folder = std::string("bad") + jobs;
        const ProcessResult result = run_meniscus(sequence(folder, {"--jobs", jobs, "--threads", "4", "-q"}));
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find("f_05.xyz"), std::string::npos) << result.err;
        for (int i = 0; i < 5; ++i) EXPECT_GT(formats::read_mesh(mesh(folder, i)).triangles.size(), 0U);
        for (int i = 5; i < frame_count; ++i) EXPECT_FALSE(std::filesystem::exists(mesh(folder, i))) << i;
    }
}

/// The command line as a process that is still under way.
class Running {
public:
    explicit Running(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), MENISCUS_CLI);
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        std::array<int, 2> pipe{};
        EXPECT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
        EXPECT_EQ(::posix_spawn(&pid_, MENISCUS_CLI, &actions, nullptr, argv.data(), environ), 0);
        posix_spawn_file_actions_destroy(&actions);
        ::close(pipe[1]);
        said_ = pipe[0];
    }
    ~Running() {
        if (pid_ > 0) kill();
        ::close(said_);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    /// Its output up to the time when this text is there, or when it has ended.
    std::string read_until(const std::string& text) {
        std::string all;
        std::array<char, 512> bytes{};
        while (all.find(text) == std::string::npos) {
            const ssize_t count = ::read(said_, bytes.data(), bytes.size());
            if (count <= 0) break;
            all.append(bytes.data(), static_cast<std::size_t>(count));
        }
        return all;
    }
    void kill() {
        ::kill(pid_, SIGKILL);
        wait();
    }
    int wait() {
        int status = 0;
        ::waitpid(std::exchange(pid_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t pid_ = -1;
    int said_ = -1;
};

TerminalProgram in_terminal(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), MENISCUS_CLI);
    return {arguments, 10, 80};
}

TEST_F(Sequences, GoOnAfterTheyWereKilledAndEndWithTheSameFiles) {
    ASSERT_EQ(run_meniscus(sequence("whole", {"-q"})).exit_code, 0);
    {
        Running running(sequence("killed", {"--jobs", "2"}));
        running.read_until("f_04.xyz: ");
        running.kill();
    }
    std::vector<bool> were_there;
    were_there.reserve(frame_count);
    for (int i = 0; i < frame_count; ++i) were_there.push_back(std::filesystem::exists(mesh("killed", i)));
    const auto skipped = std::count(were_there.begin(), were_there.end(), true);
    ASSERT_GE(skipped, 5);
    const ProcessResult result = run_meniscus(sequence("killed", {"--skip-existing", "--stats", path("rest.json")}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find(std::to_string(skipped) + " of 12 frames skipped"), std::string::npos) << result.err;
    expect_same_meshes("whole", "killed");
    const auto frames = nlohmann::json::parse(formats::read_file(path("rest.json"))).at("frames");
    EXPECT_EQ(frames.size(), std::size_t(frame_count - skipped));
    for (const auto& frame : frames) EXPECT_FALSE(were_there.at(frame.at("frame").get<std::size_t>()));
}

TEST_F(Sequences, SkipFramesOnlyIfAllTheirFilesAreThere) {
    ASSERT_EQ(run_meniscus(sequence("m", {"-q"})).exit_code, 0);
    const std::string before = formats::read_file(mesh("m", 0));
    formats::write_file(mesh("m", 0), "whole, as far as can be seen");
    ProcessResult result = run_meniscus(sequence("m", {"--skip-existing"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "12 of 12 frames skipped: their files are there\n");
    EXPECT_EQ(formats::read_file(mesh("m", 0)), "whole, as far as can be seen");
    std::filesystem::remove(mesh("m", 0));
    result = run_meniscus(
        sequence("m", {"--skip-existing", "--spray", "points", "--spray-out", path("m/s_{}.ply"), "--end", "1"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err.find("skipped"), std::string::npos) << result.err;
    EXPECT_EQ(formats::read_file(mesh("m", 0)), before);
    expect_refused({"reconstruct", in_, "--stats", path("s.json"), "-r", "0.5", "--skip-existing"}, {"-o OUT"});
}

TEST_F(Sequences, ShowABarOnATerminalAndNowhereElse) {
    const auto in_a_terminal = [&](const std::vector<std::string>& more) {
        TerminalProgram program = in_terminal(sequence("bar", more));
        std::string said = program.read_to_its_end();
        EXPECT_EQ(program.exit_code(), 0) << said;
        return said;
    };
    const std::string bar = in_a_terminal({});
    EXPECT_NE(bar.find("\r\x1b[K0 of 12 frames  ["), std::string::npos) << bar;
    EXPECT_NE(bar.find("\r\x1b[K12 of 12 frames  [==============================]  0 s left"), std::string::npos)
        << bar;
    EXPECT_NE(bar.find("\r\x1b[K12 frames, "), std::string::npos) << "in the end a line that stays: " << bar;
    EXPECT_EQ(bar.find("f_03.xyz"), std::string::npos) << bar;
    EXPECT_EQ(in_a_terminal({"-q"}), "");
    const std::string lines = in_a_terminal({"-v"});
    EXPECT_EQ(lines.find('\x1b'), std::string::npos);
    EXPECT_NE(lines.find("f_03.xyz: "), std::string::npos);
    const ProcessResult piped = run_meniscus(sequence("bar", {}));
    EXPECT_EQ(piped.err.find('\x1b'), std::string::npos);
    EXPECT_EQ(piped.err.find('\r'), std::string::npos);
    EXPECT_EQ(std::count(piped.err.begin(), piped.err.end(), '\n'), frame_count) << piped.err;
}

TEST_F(Sequences, SayErrorsAndWarningsOnLinesOfTheirOwnBesideTheBar) {
    write(frame_name(5), "not twelve");
    TerminalProgram program = in_terminal(sequence("bar", {"--field", "color", "--iso", "3"}));
    const std::string said = program.read_to_its_end();
    EXPECT_EQ(program.exit_code(), 2);
    EXPECT_NE(said.find("\r\x1b[Kmeniscus: warning: "), std::string::npos) << said;
    EXPECT_NE(said.find("\r\x1b[Kmeniscus: " + path(frame_name(5))), std::string::npos) << said;
}

TEST_F(Sequences, HaveTheAttributesOfTheFirstFrameEvenIfItIsSkipped) {
    const auto frame = [](const std::string& more) {
        return "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
               "property float age\n" +
               more;
    };
    write("a_0.ply", frame("end_header\n0 0 0 1\n"));
    write("a_1.ply", frame("property float heat\nend_header\n0 0 0 1 2\n"));
    std::vector<std::string> arguments{
        "reconstruct", path("a_{}.ply"), "-o", path("b_{}.npz"), "-r", "0.5", "--attribute", "all", "-q"};
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0);
    const std::string whole = formats::read_file(path("b_1.npz"));
    std::filesystem::remove(path("b_1.npz"));
    arguments.emplace_back("--skip-existing");
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0);
    EXPECT_TRUE(formats::read_file(path("b_1.npz")) == whole);
}

TEST_F(Sequences, AreTheSameInSharesAndGoOnWhereAShareWasKilled) {
    ASSERT_EQ(run_meniscus(sequence("whole", {"-q"})).exit_code, 0);
    for (const char* const share : {"2/5", "5/5", "1/5", "4/5"}) {
        const ProcessResult result = run_meniscus(sequence("shared", {"--share", share, "--skip-existing"}));
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err.find("skipped"), std::string::npos) << "no share looks at the others' frames";
    }
    EXPECT_FALSE(std::filesystem::exists(mesh("shared", 6))) << "of the third share, which has not run";
    ASSERT_EQ(run_meniscus(sequence("shared", {"--share", "3/5", "-q"})).exit_code, 0);
    std::filesystem::remove(mesh("shared", 6));
    const ProcessResult result = run_meniscus(sequence("shared", {"--share", "3/5", "--skip-existing"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("share 3 of 5: 2 of 12 frames\n1 of 2 frames skipped"), std::string::npos) << result.err;
    expect_same_meshes("whole", "shared");
    EXPECT_EQ(run_meniscus(sequence("shared", {"--share", "40/40"})).exit_code, 0) << "it has none";
}

TEST_F(Sequences, AreListedOnceAllSharesAreDone) {
    std::vector<std::string> arguments{"reconstruct", path("f_{}.xyz"), "-o",          path("l_{}.vtp"), "-r", "0.5",
                                       "-q",          "--pvd",          path("l.pvd"), "--share",        "1/1"};
    expect_refused(arguments, {"--pvd", "--skip-existing", "--share"});
    expect_refused(sequence("m", {"--share", "1/2", "--stats", path("s.json")}), {"--share", "--stats"});
    expect_refused({"reconstruct", in_, "-o", out_, "-r", "0.5", "--share", "1/2"}, {"--share", "{}"});
    expect_refused({"convert", in_, "-o", path("one.npz"), "--share", "1/2"}, {"--share", "{}"});
}

TEST_F(Sequences, AreConvertedInShares) {
    for (const char* const share : {"1/2", "2/2"})
        ASSERT_EQ(run_meniscus({"convert", path("f_{}.xyz"), "-o", path("c_{}.npz"), "--share", share}).exit_code, 0);
    for (int i = 0; i < frame_count; ++i) EXPECT_TRUE(std::filesystem::exists(path("c_" + number(i) + ".npz"))) << i;
    ASSERT_EQ(run_meniscus({"convert", path("f_{}.xyz"), "-o", path("d_{}.npz"), "--share", "2/12"}).exit_code, 0);
    for (int i = 0; i < frame_count; ++i)
        EXPECT_EQ(std::filesystem::exists(path("d_" + number(i) + ".npz")), i == 1) << i;
}

TEST_F(Sequences, RefuseJobsWhereThereIsNothingToShare) {
    expect_refused(sequence("m", {"--jobs", "2", "--repeat", "2"}), {"--jobs", "--repeat"});
    expect_refused(sequence("m", {"--jobs", "0"}), {"--jobs", "0"});
    expect_refused({"reconstruct", in_, "-o", out_, "-r", "0.5", "--server", "localhost:1", "--jobs", "2"},
                   {"--jobs", "--server"});
}

TEST_F(Sequences, AreListedForParaViewWithTheFramesThatWereThere) {
    std::vector<std::string> arguments{"reconstruct", path("f_{}.xyz"), "-o", path("v_{}.vtp"), "-r", "0.5",
                                       "--pvd",       path("v.pvd"),    "-q", "--end"};
    arguments.emplace_back("2");
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0);
    const std::string list = formats::read_file(path("v.pvd"));
    for (const char* file : {"\"v_00.vtp\"", "\"v_01.vtp\"", "\"v_02.vtp\""})
        EXPECT_NE(list.find(file), std::string::npos) << list;
    EXPECT_EQ(list.find(path("")), std::string::npos) << "names are relative to the list: " << list;
    std::filesystem::remove(path("v_01.vtp"));
    arguments.emplace_back("--skip-existing");
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0);
    EXPECT_EQ(formats::read_file(path("v.pvd")), list);
    expect_refused(sequence("m", {"--pvd", path("v.pvd")}), {"--pvd", "vtp", "ply"});
    expect_refused({"reconstruct", in_, "-o", path("v.vtp"), "-r", "0.5", "--pvd", path("v.pvd")}, {"--pvd", "{}"});
    arguments[7] = path("v.xml");
    expect_refused(arguments, {"v.xml", ".pvd"});
}

TEST_F(Sequences, AreOnAUsdStageWithTheFramesThatWereThere) {
    std::vector<std::string> arguments{"reconstruct", path("f_{}.xyz"), "-o", path("u_{}.usda"), "-r", "0.5",
                                       "--usd-stage", path("u.usda"),   "-q", "--end",           "2"};
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0);
    const std::string stage = formats::read_file(path("u.usda"));
    EXPECT_NE(stage.find("[@@@./u_00.usda@@@, @@@./u_01.usda@@@, @@@./u_02.usda@@@]"), std::string::npos) << stage;
    EXPECT_NE(stage.find("normal3f[] normals"), std::string::npos) << stage;
    EXPECT_NE(formats::read_file(path("u_01.usda")).find("points.timeSamples = {\n        1: ["), std::string::npos);
    std::filesystem::remove(path("u_01.usda"));
    arguments.emplace_back("--skip-existing");
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0);
    EXPECT_EQ(formats::read_file(path("u.usda")), stage);
    std::filesystem::remove(path("u.usda"));
    ASSERT_EQ(run_meniscus(arguments).exit_code, 0) << "all frames are there";
    EXPECT_EQ(formats::read_file(path("u.usda")), stage);
    expect_refused(sequence("m", {"--usd-stage", path("u.usda")}), {"--usd-stage", "usda", "ply"});
}

}  // namespace
}  // namespace meniscus::test
