// The files of the command line: sequences, pipes, disks that are full, and files that must not be destroyed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_fixture.hpp"
#include "formats/particles/vtk_writer.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::test {
namespace {

/// A PLY file of particles.
std::string ply_of_points(const std::vector<float>& positions) {
    std::string out =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(positions.size() / 3) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += std::string("property float ") + axis + "\n";
    out += "end_header\n";
    for (const float x : positions) formats::store(out, x);
    return out;
}

class CliFiles : public Cli {
protected:
    void write_frames(const std::vector<std::string>& names) const {
        ParticleFrame frame;
        frame.positions = positions_;
        for (const std::string& name : names) formats::write_vtk(directory_ / name, frame);
    }
    std::vector<std::string> sequence(std::vector<std::string> more) const {
        more.insert(more.begin(), {"reconstruct", path("f_{}.vtk"), "-o", path("m_{}.ply"), "--particle-radius", "0.5",
                                   "--cell-size", "1"});
        return more;
    }
    std::vector<int> frames_of(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments = sequence(more);
        arguments.insert(arguments.end(), {"--stats", path("s.json")});
        const ProcessResult result = run_meniscus(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        std::vector<int> numbers;
        const nlohmann::json figures = nlohmann::json::parse(formats::read_file(path("s.json")));
        for (const auto& frame : figures.at("frames")) numbers.push_back(frame.at("frame"));
        return numbers;
    }
};

TEST_F(CliFiles, ASequenceGivesItsMeshesAndFigures) {
    write_frames({"f_009.vtk", "f_010.vtk"});
    const ProcessResult result =
        run_meniscus({"reconstruct", path("f_{}.vtk"), "-o", path("m_{}.ply"), "--particle-radius", "0.5", "--start",
                      "9", "--end", "10", "--repeat", "2", "--stats", path("s.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
    EXPECT_TRUE(std::filesystem::exists(path("m_009.ply")));
    EXPECT_TRUE(std::filesystem::exists(path("m_010.ply")));
    const nlohmann::json frames = nlohmann::json::parse(formats::read_file(path("s.json"))).at("frames");
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].at("frame"), 9);
    EXPECT_EQ(frames[1].at("frame"), 10);
    EXPECT_EQ(frames[0].at("mesh_sha256"), frames[1].at("mesh_sha256"));
}

TEST_F(CliFiles, ASequenceIsAllThatIsThereUnlessTold) {
    write_frames({"f_8.vtk", "f_9.vtk", "f_11.vtk", "f_100.vtk"});
    EXPECT_EQ(frames_of({}), (std::vector<int>{8, 9, 11, 100}));
    for (const char* name : {"m_8.ply", "m_9.ply", "m_11.ply", "m_100.ply"})
        EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
    EXPECT_EQ(frames_of({"--start", "9"}), (std::vector<int>{9, 11, 100}));
    EXPECT_EQ(frames_of({"--end", "11"}), (std::vector<int>{8, 9, 11}));
    EXPECT_EQ(frames_of({"--start", "9", "--step", "2"}), (std::vector<int>{9, 11}));
    EXPECT_EQ(frames_of({"--start", "9", "--end", "12", "--step", "2"}), (std::vector<int>{9, 11}));
    EXPECT_EQ(frames_of({"--start", "7", "--end", "12", "--skip-missing"}), (std::vector<int>{8, 9, 11}));
}

TEST_F(CliFiles, RefusesAFrameThatIsNamedAndNotThere) {
    write_frames({"f_08.vtk", "f_10.vtk"});
    expect_refused(sequence({"--start", "8", "--end", "10"}), {"f_09.vtk", "no such file", "--skip-missing"});
    expect_refused(sequence({"--start", "9"}), {"f_09.vtk"});
    expect_refused(sequence({"--end", "11"}), {"f_11.vtk"});
    expect_refused(sequence({"--start", "20"}), {"f_{}.vtk", "no such file", "from 20"});
    expect_refused(sequence({"--start", "9", "--skip-missing", "--step", "2"}), {"f_{}.vtk", "--step of 2", "9"});
    expect_refused(sequence({"--step", "0"}), {"--step", "0 not in range 1 to 18446744073709551615"});
    expect_refused(sequence({"--start", "-1"}), {"--start", "-1 not in range 0 to 18446744073709551615"});
    expect_refused(reconstruct({"--step", "2"}), {"--step", "{}"});
    write_frames({"f_8.vtk"});
    expect_refused(sequence({}), {"f_8.vtk", "f_08.vtk", "frame 8"});
}

TEST_F(CliFiles, ASingleFrameSaysInOneLineWhatItMade) {
    const ProcessResult said = run_meniscus(reconstruct({}));
    EXPECT_EQ(said.exit_code, 0);
    EXPECT_EQ(said.out, "");
    EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
    for (const std::string& word :
         {in_, out_, std::string("64 particles"), std::string(" triangles"), std::string(" s")})
        EXPECT_NE(said.err.find(word), std::string::npos) << word << " in: " << said.err;
    EXPECT_EQ(run_meniscus(reconstruct({"--quiet"})).err, "");
    EXPECT_EQ(run_meniscus(reconstruct({"-q", "--repeat", "2"})).err, "");
    const std::string stages = run_meniscus(reconstruct({"-v"})).err;
    for (const std::string_view stage : names<Stage>) EXPECT_NE(stages.find(stage), std::string::npos) << stages;
}

TEST_F(CliFiles, WhatIsReadIsNotDestroyedByWhatIsWritten) {
    const std::string ply = write("particles.ply", ply_of_points(positions_));
    std::filesystem::create_symlink(ply, path("link.ply"));
    std::filesystem::create_hard_link(ply, path("twin.ply"));
    std::filesystem::create_directory(path("folder"));
    const std::string before = formats::read_file(ply);
    const std::vector<std::string> run{"reconstruct", ply, "--particle-radius", "0.5"};
    const auto refused = [&](const std::vector<std::string>& outputs) {
        std::vector<std::string> arguments = run;
        arguments.insert(arguments.end(), outputs.begin(), outputs.end());
        expect_refused(arguments, {"is the file of the input", "particles.ply"});
        EXPECT_TRUE(formats::read_file(ply) == before);
    };
    for (const std::string& out : {ply, path("folder/../particles.ply"), path("link.ply"), path("twin.ply")}) {
        refused({"-o", out});
        refused({"--stats", out});
        refused({"-o", out_, "--spray", "points", "--spray-out", out});
        expect_refused({"picture", ply, "-o", out}, {"is the file of the input"});
    }
    EXPECT_FALSE(std::filesystem::exists(out_));
    EXPECT_TRUE(std::filesystem::is_symlink(path("link.ply")));
    // Standard input is a file, too.
    EXPECT_EQ(
        run_meniscus({"reconstruct", "-", "--input-format", "ply", "-o", ply, "-r", "0.5"}, {.in = ply}).exit_code, 2);
    EXPECT_TRUE(formats::read_file(ply) == before);
}

TEST_F(CliFiles, NoFrameOfASequenceIsWrittenOverAnother) {
    for (const char* name : {"a_1.ply", "a_2.ply", "a_3.ply"}) write(name, ply_of_points(positions_));
    std::filesystem::create_hard_link(path("a_3.ply"), path("b_1.ply"));
    for (const char* out : {"a_{}.ply", "b_{}.ply"})
        expect_refused({"reconstruct", path("a_{}.ply"), "-o", path(out), "--particle-radius", "0.5"},
                       {"is the file of the input", "a_"});
    EXPECT_FALSE(std::filesystem::exists(path("b_2.ply")));
    expect_refused(reconstruct({"--stats", out_}), {"is the file of the output", "mesh.ply"});
    expect_refused(reconstruct({"--stats", path("./mesh.ply")}), {"is the file of the output", "mesh.ply"});
    expect_refused({"reconstruct", in_, "-o", "-", "--format", "ply", "--stats", "-", "-r", "0.5"},
                   {"standard output", "is the file of the output"});
}

TEST_F(CliFiles, FramesOfASequenceThatAreNotSelectedAreNotWrittenOver) {
    for (const char* name : {"f_0.ply", "f_1.ply", "f_10.ply"}) write(name, ply_of_points(positions_));
    const std::string before = formats::read_file(path("f_10.ply"));
    expect_refused(
        {"reconstruct", path("f_{}.ply"), "-o", path("f_1{}.ply"), "-r", "0.5", "--end", "0", "--skip-missing"},
        {"is the file of the input", "f_10.ply"});
    EXPECT_EQ(formats::read_file(path("f_10.ply")), before);
}

TEST_F(CliFiles, PipesTakeTheSameBytesAsFiles) {
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    const ProcessResult piped = run_meniscus(
        {"reconstruct", "-", "--input-format", "xyz", "-o", "-", "--format", "ply", "-r", "0.5"}, {.in = in_});
    EXPECT_EQ(piped.exit_code, 0);
    EXPECT_TRUE(piped.out == formats::read_file(out_));
    EXPECT_NE(piped.err.find("standard input: 64 particles"), std::string::npos) << piped.err;
    EXPECT_NE(piped.err.find(", standard output\n"), std::string::npos) << piped.err;

    ASSERT_EQ(run_meniscus({"picture", out_, "-o", path("p.png"), "--width", "60", "--height", "40"}).exit_code, 0);
    const ProcessResult picture = run_meniscus(
        {"picture", "-", "--input-format", "ply", "-o", "-", "--width", "60", "--height", "40"}, {.in = out_});
    EXPECT_EQ(picture.exit_code, 0) << picture.err;
    EXPECT_TRUE(picture.out == formats::read_file(path("p.png")));

    const ProcessResult stats = run_meniscus({"reconstruct", in_, "--stats", "-", "-r", "0.5"});
    EXPECT_EQ(nlohmann::json::parse(stats.out).at("particles"), 64);
}

TEST_F(CliFiles, ANamedPipeIsRefusedInALineThatSaysHowToReadIt) {
    const std::string pipe = path("pipe.xyz");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    expect_refused({"reconstruct", pipe, "-o", out_, "-r", "0.5"}, {pipe, "a pipe", "write -", "<" + pipe});
    expect_refused({"picture", pipe, "--input-format", "ply", "-o", path("p.png")}, {pipe, "a pipe", "write -"});
}

TEST_F(CliFiles, FormatsAreNamedWhereThereIsNoExtensionAndOverrideOne) {
    expect_refused({"reconstruct", "-", "-o", out_, "-r", "0.5"}, {"--input-format", "vtk, ply, xyz, vtu"});
    expect_refused({"reconstruct", in_, "-o", "-", "-r", "0.5"}, {"--format", "ply, obj, bricks, vtk"});
    expect_refused({"picture", "-", "-o", path("p.png")}, {"--input-format", "ply, obj, bricks, vtk"});
    expect_refused({"reconstruct", in_, "--format", "ply", "--stats", path("s.json"), "-r", "0.5"},
                   {"--format", "OUT"});
    const std::string in = write("particles.dat", formats::read_file(in_));
    expect_refused({"reconstruct", in, "-o", out_, "-r", "0.5"}, {"particles.dat", ".xyz"});
    ASSERT_EQ(run_meniscus(
                  {"reconstruct", in, "--input-format", "xyz", "-o", path("mesh.dat"), "--format", "obj", "-r", "0.5"})
                  .exit_code,
              0);
    EXPECT_TRUE(formats::read_file(path("mesh.dat")).starts_with("# Meniscus\n"));
    EXPECT_EQ(run_meniscus({"picture", path("mesh.dat"), "--input-format", "obj", "-o", path("p.png"), "--width", "60",
                            "--height", "40"})
                  .exit_code,
              0);
}

/// A failure that is not the caller's: exit code 1 and one line.
void expect_failed(const ProcessResult& result, const std::string& words) {
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
}

TEST_F(CliFiles, ADiskThatIsFullSaysSo) {
    const char* const words = "No space left on device";
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    for (const char* format : {"ply", "obj", "bricks"})
        expect_failed(
            run_meniscus({"reconstruct", in_, "-o", "-", "--format", format, "-r", "0.5", "-q"}, {.out = full}), words);
    expect_failed(run_meniscus({"reconstruct", in_, "--stats", "/dev/full", "-r", "0.5", "-q"}), words);
    expect_failed(run_meniscus({"info", "--backend", "cpu"}, {.out = full}), words);
    expect_failed(run_meniscus({"help", "reconstruct"}, {.out = full}), words);  // more than a buffer
    for (const std::vector<std::string>& asked :
         {std::vector<std::string>{"--help"}, {"reconstruct", "--help"}, {"--version"}})
        expect_failed(run_meniscus(asked, {.out = full}), words);
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    expect_failed(run_meniscus({"picture", out_, "-o", "/dev/full", "--width", "60", "--height", "40"}), words);
    expect_failed(run_meniscus({"compare", out_, out_, "--samples", "100"}, {.out = full}), words);
    ::close(full);
}

TEST_F(CliFiles, AReaderThatGoesAwayIsAnErrorLine) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
    ::close(pipe[0]);
    expect_failed(run_meniscus({"reconstruct", in_, "-o", "-", "--format", "ply", "-r", "0.5", "-q"}, {.out = pipe[1]}),
                  "Broken pipe");
    expect_failed(run_meniscus({"info", "--backend", "cpu"}, {.out = pipe[1]}), "Broken pipe");
    ::close(pipe[1]);
}

TEST_F(CliFiles, ACommandEndsWithTheReaderOfWhatItSays) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
    ::close(pipe[0]);
    const std::vector<std::string> simulate{"simulate", "--particles", "200", "--frames", "1000000"};
    EXPECT_EQ(run_meniscus(simulate, {.err = pipe[1]}).exit_code, 1);
    write_frames({"f_1.vtk", "f_2.vtk"});
    EXPECT_EQ(run_meniscus(sequence({}), {.err = pipe[1]}).exit_code, 1);
    EXPECT_TRUE(std::filesystem::exists(path("m_1.ply")));
    EXPECT_FALSE(std::filesystem::exists(path("m_2.ply")));
    EXPECT_EQ(run_meniscus(sequence({"-q"}), {.err = pipe[1]}).exit_code, 0) << "what says nothing needs no reader";
    ::close(pipe[1]);
}

TEST_F(CliFiles, NamesOfFilesAreShownWithoutWhatATerminalWouldObey) {
    const std::string bad = "a\x1b[31m\u202eb\xff", shown = "a\\u{001b}[31m\\u{202e}b\\xff";
    const auto expect_shown = [&](const std::string& text) {
        SCOPED_TRACE(text);
        EXPECT_NE(text.find(shown), std::string::npos);
        EXPECT_EQ(text.find('\x1b'), std::string::npos);
        EXPECT_EQ(text.find("\u202e"), std::string::npos);
    };
    const ProcessResult absent = run_meniscus({"convert", path(bad + ".npz"), "-o", path("out.ply")});
    EXPECT_EQ(absent.exit_code, 2);
    expect_shown(absent.err);
    expect_shown(run_meniscus({"convert", path("a.ply"), "--wrong" + bad}).err);
    // Success, a warning, and what is on standard output.
    const std::string mesh = path(bad + ".ply");
    const ProcessResult made = run_meniscus({"reconstruct", in_, "-o", mesh, "-r", "0.5"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    expect_shown(made.err);
    expect_shown(run_meniscus({"convert", mesh, "-o", path("out.obj")}).err);
    expect_shown(run_meniscus({"reconstruct", mesh, "-o", path("again.ply"), "-r", "0.5"}).err);
    const ProcessResult checked = run_meniscus({"check", mesh});
    EXPECT_EQ(checked.exit_code, 0);
    expect_shown(checked.out);
}

}  // namespace
}  // namespace meniscus::test
