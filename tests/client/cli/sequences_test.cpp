// meniscus reconstruct on sequences: several frames at a time, the bar, runs that were interrupted, boxes and checks.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
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
        const std::string said = program.read_to_its_end();
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
    expect_refused(arguments, {"u.usda", "all frames were skipped"});
    expect_refused(sequence("m", {"--usd-stage", path("u.usda")}), {"--usd-stage", "usda", "ply"});
}

class Boxes : public Cli {
protected:
    /// The smallest and the largest x of a mesh.
    static std::array<double, 2> extent(const formats::TriangleMesh& mesh) {
        std::array<double, 2> out{1e9, -1e9};
        for (const auto& p : mesh.positions) {
            out[0] = std::min(out[0], p[0]);
            out[1] = std::max(out[1], p[0]);
        }
        return out;
    }
};

TEST_F(Boxes, LeaveParticlesOutBeforeTheReconstruction) {
    // The left half alone is what a file of its particles gives.
    std::string left;
    for (std::size_t i = 0; i < positions_.size(); i += 3)
        for (std::size_t a = 0; a < 3 && positions_[i] <= 2.0F; ++a) formats::store(left, positions_[i + a]);
    ASSERT_EQ(run_meniscus(reconstruct({"--particle-aabb", "-1", "-9", "-9", "2", "9", "9"})).exit_code, 0);
    const std::string cropped = formats::read_file(out_);
    const std::string alone = write("left.xyz", left);
    ASSERT_EQ(run_meniscus({"reconstruct", alone, "-o", path("left.ply"), "-r", "0.5"}).exit_code, 0);
    EXPECT_TRUE(cropped == formats::read_file(path("left.ply")));
    expect_refused(reconstruct({"--particle-aabb", "1", "0", "0", "0", "1", "1"}), {"--particle-aabb", "1 to 0", "x"});
    expect_refused(reconstruct({"--particle-aabb", "1", "0", "0", "2"}), {"--particle-aabb", "6"});
}

/// PLY with float64 positions.
std::string wide_ply(const std::vector<float>& positions, const std::array<double, 3>& moved) {
    std::string out =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(positions.size() / 3) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += std::string("property double ") + axis + "\n";
    out += "end_header\n";
    for (std::size_t i = 0; i < positions.size(); ++i)
        formats::store(out, static_cast<double>(positions[i]) / 8.0 + moved[i % 3]);
    return out;
}

TEST_F(Boxes, AnOriginKeepsCoordinatesFarFromZeroExactly) {
    const std::array<double, 3> far{4'600'000.0, 300'000'000.0, -7.0};
    const std::string near_file = write("near.ply", wide_ply(positions_, {}));
    const std::string far_file = write("far.ply", wide_ply(positions_, far));
    const auto run = [&](const std::string& in, const std::string& out, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"reconstruct", in,        "-o",           out,        "-r",
                                           "0.0625",      "--stats", path("s.json"), "--strict", "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run_meniscus(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(formats::read_file(path("s.json")));
    };
    const std::vector<std::string> origin{"--origin", "4600000", "300000000", "-7"};
    const auto with_origin = [&](std::vector<std::string> more) {
        more.insert(more.end(), origin.begin(), origin.end());
        return more;
    };
    EXPECT_EQ(run(far_file, path("far_mesh.ply"), origin).at("mesh_sha256"),
              run(near_file, path("near_mesh.ply"), {}).at("mesh_sha256"));
    const formats::TriangleMesh near_mesh = formats::read_mesh(path("near_mesh.ply"));
    const formats::TriangleMesh far_mesh = formats::read_mesh(path("far_mesh.ply"));
    ASSERT_EQ(far_mesh.triangles, near_mesh.triangles);
    for (std::size_t v = 0; v < near_mesh.positions.size(); ++v)
        for (std::size_t a = 0; a < 3; ++a)
            EXPECT_NEAR(far_mesh.positions[v][a] - far[a], near_mesh.positions[v][a], 6e-8) << "a float64's step";
    // Boxes are in the coordinates of the file.
    EXPECT_EQ(run(far_file, path("far_mesh.ply"),
                  with_origin({"--domain", "4600000", "300000000", "-7", "4600000.3", "300000001", "0"}))
                  .at("mesh_sha256"),
              run(near_file, path("near_mesh.ply"), {"--domain", "0", "0", "0", "0.3", "1", "7"}).at("mesh_sha256"));
    EXPECT_EQ(run(far_file, path("far_mesh.ply"),
                  with_origin({"--particle-aabb", "4600000", "300000000", "-7", "4600000.3", "300000001", "0"}))
                  .at("particles"),
              32);
    run(far_file, path("far_mesh.ply"),
        with_origin({"--mesh-aabb", "4600000", "299999999", "-9", "4600000.3", "300000001", "0"}));
    EXPECT_LT(extent(formats::read_mesh(path("far_mesh.ply")))[1], 4'600'000.4);
    expect_refused({"reconstruct", far_file, "-o", path("m.bricks"), "-r", "0.0625", "--origin", "1", "2", "3"},
                   {"--origin", "bricks"});
}

TEST_F(Boxes, WhereFloat32MovesParticlesAWarningNamesTheOriginThatKeepsThem) {
    const std::string file = write("far.ply", wide_ply(positions_, {40'000.0, 0.0, 0.0}));
    const ProcessResult result = run_meniscus({"reconstruct", file, "-o", out_, "-r", "0.0625"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("warning"), std::string::npos) << "float32 holds them: " << result.err;
    std::vector<float> thirds = positions_;
    for (float& x : thirds) x /= 3.0F;
    write("far.ply", wide_ply(thirds, {40'000.0, 0.0, 0.0}));
    const ProcessResult rounded = run_meniscus({"reconstruct", file, "-o", out_, "-r", "0.02", "--strict"});
    EXPECT_EQ(rounded.exit_code, 3);
    EXPECT_NE(rounded.err.find("a hundredth of the particle radius: --origin 40000 0 0 keeps them\n"),
              std::string::npos)
        << rounded.err;
    EXPECT_EQ(run_meniscus({"reconstruct", file, "-o", out_, "-r", "0.02", "--origin", "40000", "0", "0", "--strict"})
                  .exit_code,
              0);
}

TEST_F(Boxes, CropTheMeshByWholeTriangles) {
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    const formats::TriangleMesh whole = formats::read_mesh(out_);
    const ProcessResult result =
        run_meniscus(reconstruct({"--mesh-aabb", "-9", "-9", "-9", "0.6", "9", "9", "--check"}));
    EXPECT_EQ(result.exit_code, 4) << "a cropped mesh is open";
    EXPECT_NE(result.err.find("meniscus: check: " + out_ + ": "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("edges of one triangle: the mesh is open there"), std::string::npos) << result.err;
    const formats::TriangleMesh part = formats::read_mesh(out_);
    EXPECT_LT(part.triangles.size(), whole.triangles.size());
    EXPECT_EQ(extent(part)[0], extent(whole)[0]);
    EXPECT_GT(extent(part)[1], 0.6);
    EXPECT_LT(extent(part)[1], 1.6) << "a triangle further than the box, at most";
    expect_refused(
        {"reconstruct", in_, "-o", path("m.bricks"), "-r", "0.5", "--mesh-aabb", "0", "0", "0", "1", "1", "1"},
        {"--mesh-aabb", "bricks", "--domain"});
}

TEST_F(Boxes, QuadsAreWrittenInTheFormatsThatHaveThem) {
    for (const char* name : {"m.ply", "m.npz", "m.bricks", "m.glb", "m.usda", "m.stl"})
        expect_refused({"reconstruct", in_, "-o", path(name), "-r", "0.5", "--quads"},
                       {"--quads", "obj, vtk, vtp or vtu"});
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    const formats::TriangleMesh plain = formats::read_mesh(out_);
    std::array<std::vector<Triangle>, 4> cut;
    std::size_t i = 0;
    for (const char* name : {"q.obj", "q.vtk", "q.vtp", "q.vtu"}) {
        ASSERT_EQ(run_meniscus({"reconstruct", in_, "-o", path(name), "-r", "0.5", "--quads", "--check"}).exit_code, 0);
        const formats::TriangleMesh mesh = formats::read_mesh(path(name));
        ASSERT_EQ(mesh.positions.size(), plain.positions.size()) << name;
        // OBJ has the shortest decimals of float32.
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            for (std::size_t axis = 0; axis < 3; ++axis)
                ASSERT_EQ(static_cast<float>(mesh.positions[v][axis]), static_cast<float>(plain.positions[v][axis]))
                    << name;
        EXPECT_EQ(mesh.triangles.size(), plain.triangles.size()) << name;
        for (std::uint8_t level = 0; level < 4; ++level)
            EXPECT_EQ(std::count(mesh.levels.begin(), mesh.levels.end(), level),
                      std::count(plain.levels.begin(), plain.levels.end(), level))
                << name;
        EXPECT_EQ(run_meniscus({"check", path(name)}).exit_code, 0) << name;
        cut.at(i++) = mesh.triangles;
    }
    EXPECT_EQ(cut[0], cut[1]);
    EXPECT_EQ(cut[0], cut[2]);
    EXPECT_EQ(cut[0], cut[3]);
    const std::string text = formats::read_file(path("q.obj"));
    std::size_t quads = 0;
    for (std::size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) {
        const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
        if (std::count(line.begin(), line.end(), ' ') == 4) ++quads;
    }
    EXPECT_GT(quads, plain.triangles.size() / 8);
}

TEST_F(Boxes, LevelsOfTrianglesAreLeftOutOnDemand) {
    for (const std::string format : {"ply", "vtk", "vtp", "vtu", "npz", "obj"}) {
        const std::string with = path("with." + format), without = path("without." + format);
        ASSERT_EQ(run_meniscus({"reconstruct", in_, "-o", with, "-r", "0.5"}).exit_code, 0);
        ASSERT_EQ(run_meniscus({"reconstruct", in_, "-o", without, "-r", "0.5", "--no-triangle-levels"}).exit_code, 0);
        const formats::TriangleMesh plain = formats::read_mesh(with), bare = formats::read_mesh(without);
        EXPECT_EQ(plain.levels.size(), plain.triangles.size()) << format;
        EXPECT_TRUE(bare.levels.empty()) << format;
        EXPECT_EQ(bare.positions, plain.positions) << format;
        EXPECT_EQ(bare.normals, plain.normals) << format;
        EXPECT_EQ(bare.triangles, plain.triangles) << format;
        // The same of a file that has them.
        const std::string converted = path("converted." + format);
        ASSERT_EQ(run_meniscus({"convert", with, "-o", converted, "--mesh", "--no-triangle-levels"}).exit_code, 0);
        EXPECT_EQ(formats::read_file(converted), formats::read_file(without)) << format;
    }
    expect_refused({"reconstruct", in_, "-o", path("m.bricks"), "-r", "0.5", "--no-triangle-levels"},
                   {"--no-triangle-levels", "bricks"});
}

TEST_F(Boxes, CompressedFilesAreSmallerAndHoldTheSame) {
    for (const char* name : {"m.ply", "m.obj", "m.vtk", "m.npz", "m.bricks", "m.usda", "m.stl"})
        expect_refused({"reconstruct", in_, "-o", path(name), "-r", "0.5", "--compress"},
                       {"--compress", "glb, vtp or vtu, not"});
    for (const std::string format : {"glb", "vtp", "vtu"}) {
        ASSERT_EQ(run_meniscus({"reconstruct", in_, "-o", path("plain." + format), "-r", "0.5"}).exit_code, 0);
        ASSERT_EQ(
            run_meniscus({"reconstruct", in_, "-o", path("small." + format), "-r", "0.5", "--compress"}).exit_code, 0);
        EXPECT_LT(std::filesystem::file_size(path("small." + format)),
                  std::filesystem::file_size(path("plain." + format)) * 3 / 4)
            << format;
    }
    const formats::TriangleMesh plain = formats::read_mesh(path("plain.vtp"));
    const formats::TriangleMesh small = formats::read_mesh(path("small.vtp"));
    EXPECT_EQ(small.positions, plain.positions);
    EXPECT_EQ(small.triangles, plain.triangles);
    EXPECT_EQ(small.levels, plain.levels);
    EXPECT_NE(formats::read_file(path("small.glb")).find("KHR_draco_mesh_compression"), std::string::npos);
}

TEST_F(Boxes, ChecksNameEachKindOfDefect) {
    ASSERT_EQ(run_meniscus(reconstruct({"--check"})).exit_code, 0);
    const ProcessResult good = run_meniscus({"check", out_});
    EXPECT_EQ(good.exit_code, 0);
    EXPECT_NE(good.out.find("closed, manifold and consistently oriented\n"), std::string::npos) << good.out;
    const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const auto check = [&](const std::string& faces, const std::string& words) {
        const ProcessResult result = run_meniscus({"check", "-q", write("m.obj", tetrahedron + faces)});
        EXPECT_EQ(result.exit_code, 4);
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    };
    EXPECT_EQ(run_meniscus({"check", write("m.obj", tetrahedron + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")}).exit_code,
              0);
    check("f 1 3 2\nf 1 2 4\nf 2 3 4\n", ": 3 edges of one triangle: the mesh is open there\n");
    check("f 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
          ": 3 edges whose triangles run the same way: the orientation is not consistent\n");
    check("f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 3 2\n", "edges of more than two triangles: not manifold\n");
    check("f 1 1 2\n", ": 1 triangle with a vertex twice\n");
}

TEST_F(Boxes, InputsAreRefusedBeyondTheirLimit) {
    const std::string size = std::to_string(std::filesystem::file_size(in_));
    EXPECT_EQ(run_meniscus(reconstruct({"--max-file-bytes", size})).exit_code, 0);
    expect_refused(reconstruct({"--max-file-bytes", "767"}), {in_, "767", "--max-file-bytes"});
    EXPECT_EQ(run_meniscus(reconstruct({"--max-file-bytes", "1K"})).exit_code, 0);
    const ProcessResult piped = run_meniscus(
        {"reconstruct", "-", "--input-format", "xyz", "-o", out_, "-r", "0.5", "--max-file-bytes", "767"}, {.in = in_});
    EXPECT_EQ(piped.exit_code, 2);
    EXPECT_NE(piped.err.find("standard input"), std::string::npos) << piped.err;
    for (const std::vector<std::string>& command : {std::vector<std::string>{"check", out_},
                                                    {"picture", out_, "-o", path("p.png")},
                                                    {"compare", out_, out_},
                                                    {"convert", out_, "-o", path("m.obj")}}) {
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.end(), {"--max-file-bytes", "100"});
        expect_refused(arguments, {out_, "100", "--max-file-bytes"});
    }
}

}  // namespace
}  // namespace meniscus::test
