// The command line as a process: exit codes, the one line, the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli_fixture.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/vtk_writer.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::test {
namespace {

TEST_F(Cli, PrintsItsVersion) {
    const ProcessResult result = run_meniscus({"--version"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out.rfind("meniscus ", 0), 0U) << result.out;
}

TEST_F(Cli, InfoWithoutAServerDescribesThisProcess) {
    const ProcessResult result = run_meniscus({"info", "--backend", "cpu"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("backend                cpu (asked for)\n"), std::string::npos) << result.out;
}

TEST_F(Cli, InfoNamesTheGpuOrSaysInOneLineWhyThereIsNone) {
    const ProcessResult result = run_meniscus({"info", "--backend", "cuda"});
    if (result.exit_code == 0)
        EXPECT_NE(result.out.find("backend                cuda"), std::string::npos) << result.out;
    else
        expect_refused({"info", "--backend", "cuda"}, {"CUDA backend cannot be used"});
}

TEST_F(Cli, RefusesBadArguments) {
    expect_refused({}, {"subcommand"});
    expect_refused({"levitate"}, {"levitate"});
    expect_refused(reconstruct({"--frobnicate"}), {"--frobnicate"});
    expect_refused(reconstruct({"--field", "magic"}), {"--field", "magic", "color", "density"});
    expect_refused(reconstruct({"--mode", "magic"}), {"--mode", "magic"});
    expect_refused(reconstruct({"--cell-size", "abc"}), {"--cell-size", "abc"});
    expect_refused(reconstruct({"--domain", "0", "0", "0"}), {"--domain", "6"});
    expect_refused(reconstruct({"--repeat", "0"}), {"--repeat", "0"});
    expect_refused(reconstruct({"--threads", "100000"}), {"--threads", "100000", "1024"});
    expect_refused({"simulate", "--threads", "1025"}, {"--threads", "1025", "1024"});
    for (const char* bits : {"1", "17", "2.5", "-2", "eight"})
        expect_refused(reconstruct({"--normal-bits", bits}),
                       {"--normal-bits: " + std::string(bits) + " is not 0 or a whole number from 2 to 16"});
    expect_refused({"info", "--server", "::1"}, {"::1", "[::1]:50051"});
    expect_refused({"info", "--server", "localhost:116087"}, {"localhost:116087", "65535"});
    expect_refused(reconstruct({"--backend", "abacus"}), {"backend", "abacus", "auto", "cpu", "cuda"});
    expect_refused({"reconstruct", in_, "-o", out_}, {"--particle-radius"});
    expect_refused({"reconstruct", in_, "--particle-radius", "0.5"}, {"-o", "--stats"});
}

TEST_F(Cli, TakesTheValueOfAShortFlagInEachNotation) {
    for (const std::vector<std::string>& radius :
         std::vector<std::vector<std::string>>{{"-r", "0.5"}, {"-r0.5"}, {"-r=0.5"}, {"--particle-radius=0.5"}}) {
        std::vector<std::string> command{"reconstruct", in_, "-o", out_, "-q"};
        command.insert(command.end(), radius.begin(), radius.end());
        const ProcessResult result = run_meniscus(command);
        EXPECT_EQ(result.exit_code, 0) << radius.front() << ": " << result.err;
    }
    expect_refused({"reconstruct", in_, "-o", out_, "-r=half"}, {"--particle-radius", "half"});
}

TEST_F(Cli, AnswersASequenceInAnotherNotationWithItsOwn) {
    for (const char* name : {"f_*.vtk", "f_%03d.vtk"}) {
        expect_refused({"reconstruct", path(name), "-o", out_, "-r", "0.5"},
                       {"no such file", "has {} for the numbers"});
        expect_refused({"convert", path(name), "-o", path("f_{}.ply")}, {"no such file", "has {} for the numbers"});
    }
}

TEST_F(Cli, RefusesNumbersBeyondTheirRangeAndWhatIsNoNumber) {
    for (const std::string value : {"1e9", "nan"})
        for (const auto& [command, range] : std::vector<std::pair<std::vector<std::string>, std::string>>{
                 {{"info", "--server", "localhost:1", "--wait"}, "0 to 86400"},
                 {{"top", "--server", "localhost:1", "--interval"}, "0.1 to 3600"},
                 {{"simulate", "--frames", "1", "--frame-seconds"}, "0.0001 to 1"},
                 {{"picture", in_, "-o", path("p.png"), "--view", "0"}, "-360 to 360"},
                 {{"watch", "one", "--server", "localhost:1", "-o", path("w"), "--timeout"}, "0 to 1000000"},
                 {{"watch", "one", "--server", "localhost:1", "-o", path("w"), "--reconnect"}, "0 to 1000000"}}) {
            std::vector<std::string> arguments = command;
            arguments.push_back(value);
            std::string answer = value;
            answer.append(" not in range ").append(range);
            expect_refused(arguments, {command.back() == "0" ? "--view" : command.back(), answer});
        }
}

TEST_F(Cli, RefusesOptionsThatAreEmptyInPlaceOfTakingThemAsNotGiven) {
    expect_refused(reconstruct({"--server", ""}), {"--server", "empty", "HOST:PORT"});
    expect_refused({"info", "--server", ""}, {"--server", "empty", "HOST:PORT"});
    for (const char* flag : {"--session", "--name", "--length-unit", "--tls-ca", "--token-file"})
        expect_refused({"simulate", "--frames", "1", "--server", "127.0.0.1:1", flag, ""}, {flag, "empty"});
}

TEST_F(Cli, RefusesParametersOfAChoiceThatIsNotMade) {
    expect_refused(reconstruct({"--criterion", "count", "--tolerance", "0.2"}),
                   {"--tolerance", "--criterion curvature", "count"});
    expect_refused(reconstruct({"--count-threshold", "2"}), {"--count-threshold", "--criterion count", "curvature"});
    expect_refused(reconstruct({"--edge-points", "interpolate", "--bisection-steps", "3"}),
                   {"--bisection-steps", "--edge-points bisect", "interpolate"});
}

TEST_F(Cli, RefusesWhatBelongsToAnotherFieldInALineThatSaysWhatToDo) {
    expect_refused(reconstruct({"--smoothing-length", "2"}),
                   {"smoothing length is 2", "--smoothness", "--field color"});
    expect_refused(reconstruct({"--field", "smooth", "--smoothing-length", "2"}),
                   {"smoothing length is 2", "--smoothness", "--field color"});
    expect_refused({"simulate", "--frames", "1", "--field", "smooth", "--smoothing-length", "2"},
                   {"smoothing length is 2", "--smoothness", "--field color"});
    expect_refused(reconstruct({"--field", "smooth", "--smoothness", "8"}), {"smoothness is 8", "5 to 7"});
    expect_refused(reconstruct({"--field", "smooth", "--smoothness", "six"}), {"--smoothness", "six"});
    expect_refused(reconstruct({"--field", "color", "--smoothness", "6"}), {"--smoothing-length", "--field smooth"});
    expect_refused(reconstruct({"--field", "color", "--spray", "discard"}), {"spray", "--field smooth"});
    expect_refused(reconstruct({"--preset", "foam"}), {"--preset", "foam", "smooth", "paper", "splashsurf"});
}

TEST_F(Cli, APresetIsTheFlagsThatItStandsFor) {
    const auto hash = [&](const std::vector<std::string>& flags) {
        return stats(flags).at("mesh_sha256").get<std::string>();
    };
    const std::string paper = hash({"--preset", "paper"});
    EXPECT_EQ(hash({"--field", "density", "--criterion", "count", "--edge-points", "bisect"}), paper);
    EXPECT_NE(hash({"--preset", "paper", "--criterion", "curvature"}), paper);
    EXPECT_EQ(hash({"--preset", "splashsurf"}), hash({"--field", "color", "--mode", "uniform"}));
    EXPECT_EQ(hash({"--preset", "splashsurf", "--mode", "adaptive"}), hash({"--field", "color"}));
    EXPECT_EQ(hash({"--preset", "smooth"}), hash({}));
}

TEST_F(Cli, PassesParametersOnWithTheirChoice) {
    for (const char* threshold : {"0", "1"}) {
        const auto flags = reconstruct({"--count-threshold", threshold, "--criterion", "count"});
        if (threshold == std::string_view("0"))
            expect_refused(flags, {"count threshold is 0"});
        else
            EXPECT_EQ(run_meniscus(flags).exit_code, 0);
    }
    expect_refused(reconstruct({"--tolerance", "-1"}), {"tolerance is -1"});
    expect_refused(reconstruct({"--edge-points", "bisect", "--bisection-steps", "8"}), {"bisection steps are 8"});
    EXPECT_EQ(run_meniscus(reconstruct({"--bisection-steps", "7", "--edge-points", "bisect"})).exit_code, 0);
}

TEST_F(Cli, RefusesContradictions) {
    expect_refused(reconstruct({"--local", "--server", "localhost:1"}), {"--local", "--server"});
    expect_refused(reconstruct({"--threads", "2", "--server", "localhost:1"}), {"--threads", "--server"});
    expect_refused(reconstruct({"--backend", "cpu", "--server", "localhost:1"}), {"--backend", "--server"});
    expect_refused({"info", "--backend", "cpu", "--server", "localhost:1"}, {"--backend", "--server"});
    expect_refused(reconstruct({"--start", "1"}), {"--start"});
    expect_refused({"reconstruct", path("f_{}.vtk"), "-o", path("m_{}.ply"), "--particle-radius", "1"},
                   {"f_{}.vtk", "no such file"});
    expect_refused(
        {"reconstruct", path("f_{}.vtk"), "-o", out_, "--particle-radius", "1", "--start", "1", "--end", "2"}, {"{}"});
    expect_refused(reconstruct({"--quiet", "--verbose"}), {"--quiet", "--verbose"});
    expect_refused(reconstruct({"--no-normals", "--normal-bits", "8"}), {"--normal-bits 8", "--no-normals"});
    EXPECT_EQ(run_meniscus(reconstruct({"--no-normals", "--normal-bits", "0"})).exit_code, 0);
    for (const char* bits : {"0", "8"})
        expect_refused(reconstruct({"--normals-by", "receiver", "--normal-bits", bits}),
                       {"--normal-bits " + std::string(bits), "--normals-by receiver", "give one of the two"});
    EXPECT_EQ(run_meniscus(reconstruct({"--normals-by", "server", "--normal-bits", "8"})).exit_code, 0);
    expect_refused({"reconstruct", in_, "-o", path("out.bricks"), "--particle-radius", "1", "--normals-by", "receiver"},
                   {"--normals-by receiver", "files of bricks", "--normal-bits 0"});
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--normal-bits", "8"}, {"--format", "bricks"}}) {
        std::vector<std::string> arguments{"watch", "one",           "--server",     "localhost:1",
                                           "-o",    path("watched"), "--normals-by", "receiver"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_refused(arguments, {more[0] == "--format" ? "files of bricks" : "--normal-bits 8"});
    }
    expect_refused({"reconstruct", path("f_{}.vtk"), "-o", path("m_{}.ply"), "--particle-radius", "1", "--start", "3",
                    "--end", "2"},
                   {"3", "2"});
    expect_refused({"simulate", "--session", "0", "--frames", "1"}, {"--session", "--server"});
}

TEST_F(Cli, RefusesSettingsOutOfRange) {
    expect_refused({"reconstruct", in_, "-o", out_, "--particle-radius", "0"}, {"radius", "0"});
    expect_refused({"reconstruct", in_, "-o", out_, "--particle-radius", "-1.5"}, {"radius", "-1.5"});
    expect_refused({"reconstruct", in_, "-o", out_, "--particle-radius", "nan"}, {"radius", "nan"});
    expect_refused(reconstruct({"--cell-size", "0"}), {"cell", "0"});
    expect_refused(reconstruct({"--iso", "-2"}), {"iso", "-2"});
    expect_refused(reconstruct({"--edge-points", "bisect", "--bisection-steps", "99"}), {"99"});
    expect_refused(reconstruct({"--domain", "1", "0", "0", "0", "1", "1"}), {"1"});
}

TEST_F(Cli, RefusesFilesThatAreNoParticles) {
    const auto refused = [&](const std::string& in, const std::vector<std::string>& words) {
        expect_refused({"reconstruct", in, "-o", out_, "--particle-radius", "0.5"}, words);
    };
    refused(path("none.vtk"), {"none.vtk", "no such file"});
    refused(directory_.path().string(), {directory_.path().string()});
    refused(write("a.txt", "hello"), {"a.txt", ".vtk"});
    refused(write("a.vtk", "hello"), {"a.vtk", "not a legacy VTK file"});
    refused(write("a.ply", "hello"), {"a.ply", "not a PLY file"});
    refused(write("a.xyz", "hello"), {"a.xyz", "5 bytes", "12"});
    refused(write("short.vtk", vtk_binary().substr(0, 90)), {"short.vtk", "truncated"});
    std::string lying = vtk_binary();
    lying.replace(lying.find("POINTS 2"), 8, "POINTS 77777777777");
    refused(write("lying.vtk", lying), {"lying.vtk", "bytes follow"});
    EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Cli, RefusesPositionsThatAreNotFinite) {
    for (const char* value : {"nan", "inf"}) {
        std::string text = vtk_ascii();
        text.replace(text.find("4 5 6"), 5, std::string("4 ") + value + " 6");
        expect_refused({"reconstruct", write("bad.vtk", text), "-o", out_, "--particle-radius", "0.5"},
                       {"bad.vtk", "particle 1", value});
    }
}

TEST_F(Cli, RefusesOutputsThatCannotBeWritten) {
    const auto refused = [&](const std::string& out, const std::vector<std::string>& words) {
        expect_refused({"reconstruct", in_, "-o", out, "--particle-radius", "0.5"}, words);
    };
    refused(path("no/such/mesh.ply"), {"no/such", "cannot be written"});
    refused(path("mesh.off"), {"mesh.off", ".ply"});
    expect_refused(reconstruct({"--stats", path("no/such/s.json")}), {"no/such", "cannot be written"});
    std::filesystem::create_directory(directory_ / "folder.ply");
    refused(path("folder.ply"), {"folder.ply", "directory"});
    expect_refused({"picture", write("m.obj", "v 0 0 0\n"), "-o", "/no/such/p.png"},
                   {"/no/such/p.png", "cannot be written"});
    expect_refused({"picture", path("none.ply"), "-o", path("p.png")}, {"none.ply", "no such file"});
    expect_refused({"picture", path("m.obj"), "-o", path("p.png"), "--width", "0"}, {"--width", "0"});
}

TEST_F(Cli, RefusesAServerThatIsNotThere) {
    expect_refused(reconstruct({"--server", "127.0.0.1:1"}), {"127.0.0.1:1"});
    expect_refused({"info", "--server", "127.0.0.1:1"}, {"127.0.0.1:1"});
    expect_refused({"watch", "some-session", "--server", "127.0.0.1:1", "-o", path("meshes")}, {"127.0.0.1:1"});
}

TEST_F(Cli, StatisticsHaveEveryFigure) {
    const nlohmann::json s = stats({"--threads", "1", "--repeat", "3"});
    EXPECT_EQ(s.at("particles"), 64);
    for (const char* key :
         {"vertices", "triangles", "field_evaluations", "total_seconds", "first_seconds", "peak_bytes"})
        EXPECT_GT(s.at(key).get<double>(), 0.0) << key;
    // Particles of radius 0.5 in two halves far from each other, each in company.
    EXPECT_DOUBLE_EQ(s.at("particle_volume").get<double>(), 64.0);
    EXPECT_NEAR(s.at("volume").get<double>(), 64.0, 32.0);
    EXPECT_EQ(s.at("spray_particles"), 0);
    std::uint64_t triangles = 0;
    for (const char* level : {"level1", "level2", "level3", "crack"})
        triangles += s.at("triangles_by_level").at(level).get<std::uint64_t>();
    EXPECT_EQ(s.at("triangles"), triangles);
    for (const char* level : {"level1", "level2", "level3"}) EXPECT_TRUE(s.at("base_cells_by_level").contains(level));
    for (const std::string_view stage : names<Stage>)
        EXPECT_GE(s.at("stage_seconds").at(std::string(stage)).get<double>(), 0.0) << stage;
    EXPECT_EQ(s.at("backend"), "cpu");
    EXPECT_EQ(s.at("threads"), 1);
    EXPECT_EQ(s.at("mesh_sha256").get<std::string>().size(), 64U);
    const auto mesh = formats::read_mesh(out_);
    EXPECT_EQ(s.at("triangles"), mesh.triangles.size());
    EXPECT_EQ(s.at("vertices"), mesh.positions.size());
}

TEST_F(Cli, ThreadsDoNotChangeTheMesh) {
    for (const char* mode : {"adaptive", "uniform"})
        EXPECT_EQ(stats({"--mode", mode, "--threads", "1"}).at("mesh_sha256"),
                  stats({"--mode", mode, "--threads", "2"}).at("mesh_sha256"));
}

TEST_F(Cli, EveryOutputFormatHoldsTheSameTriangles) {
    const std::uint64_t triangles = stats({}).at("triangles");
    for (const char* name : {"m.ply", "m.obj", "m.bricks"}) {
        const ProcessResult result = run_meniscus({"reconstruct", in_, "-o", path(name), "--particle-radius", "0.5"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const formats::TriangleMesh mesh = formats::read_mesh(path(name));
        EXPECT_EQ(mesh.triangles.size(), triangles) << name;
        EXPECT_EQ(mesh.levels.size(), triangles) << name;
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size()) << name;
        EXPECT_EQ(
            run_meniscus({"picture", path(name), "-o", path("p.png"), "--wireframe", "--width", "60", "--height", "40"})
                .exit_code,
            0);
    }
}

TEST_F(Cli, FilesOfBricksHoldTheSameMeshInEveryCodec) {
    const auto written = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"reconstruct", in_, "-o", path("m.bricks"), "-r", "0.5"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run_meniscus(arguments).exit_code, 0);
        return formats::read_bricks("m.bricks", formats::read_file(path("m.bricks")));
    };
    const std::string expected = stats({}).at("mesh_sha256");
    for (const Codec codec : codecs) {
        const client::ReceivedFrame frame = written({"--codec", std::string(name_of(codec))});
        for (const auto& brick : frame.bricks) EXPECT_EQ(brick->codec, codec);
        EXPECT_EQ(mesh_sha256(frame.mesh()), expected) << name_of(codec);
        EXPECT_EQ(run_meniscus({"convert", path("m.bricks"), "-o", out_}).exit_code, 0) << name_of(codec);
    }
    EXPECT_EQ(written({}).bricks.at(0)->codec, Codec::lattice_entropy);
    expect_refused(reconstruct({"--codec", "packed"}), {"--codec", "--server", "bricks"});
    expect_refused(reconstruct({"--codec", "zip"}), {"--codec", "zip", "entropy", "packed", "draco"});
}

TEST_F(Cli, WritesThePointsThatAreLeftOutOfTheSurface) {
    std::string bytes;
    for (const float x : {1.0F, -2.0F, 3.0F}) formats::store(bytes, x);
    const std::string lone = write("lone.xyz", bytes);
    const std::string spray = path("spray.ply");
    const std::vector<std::string> arguments{"reconstruct",       lone,  "-o",          out_,
                                             "--particle-radius", "0.5", "--spray-out", spray};
    expect_refused(arguments, {"--spray-out", "keep", "points"});
    std::vector<std::string> points = arguments;
    points.insert(points.end(), {"--spray", "points"});
    const ProcessResult result = run_meniscus(points);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(formats::read_mesh(out_).triangles.empty());
    const std::vector<float> written = formats::read_particles(spray).positions;
    ASSERT_EQ(written.size(), 3U);
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(written[axis], (std::vector<float>{1.0F, -2.0F, 3.0F})[axis], 1e-3);
    points[7] = path("spray.obj");
    expect_refused(points, {"spray.obj", ".ply"});
}

TEST_F(Cli, AnEmptyFrameGivesAnEmptyMeshAndAWarning) {
    const std::string empty = write("empty.xyz", "");
    for (const char* positions : {"float32", "uint16"}) {
        std::vector<std::string> command{"reconstruct",       empty, "-o",          out_,
                                         "--particle-radius", "0.5", "--positions", positions};
        const ProcessResult result = run_meniscus(command);
        EXPECT_EQ(result.exit_code, 0);
        const std::string warning =
            "meniscus: warning: " + empty + ": the surface is empty: the file has no particles\n";
        EXPECT_TRUE(result.err.starts_with(warning)) << result.err;
        EXPECT_TRUE(formats::read_mesh(out_).triangles.empty());
        command.emplace_back("--strict");
        EXPECT_EQ(run_meniscus(command).exit_code, 3);
    }
    const ProcessResult outside =
        run_meniscus({"reconstruct", write("two.xyz", std::string(24, '\0')), "-o", out_, "--particle-radius", "0.5",
                      "--particle-aabb", "4", "4", "4", "5", "5", "5", "--stats", path("s.json"), "-q"});
    EXPECT_NE(outside.err.find("all 2 particles of the file lie outside --particle-aabb"), std::string::npos)
        << outside.err;
    const nlohmann::json figures = nlohmann::json::parse(formats::read_file(path("s.json")));
    EXPECT_EQ(figures.at("warnings").at(0).at("code"), "no_particles");
}

TEST_F(Cli, SimulatesAndWritesParticlesThatItReadsBack) {
    const ProcessResult result =
        run_meniscus({"simulate", "--local", "--particles", "500", "--frames", "3", "--adaptive", "--positions",
                      "uint16", "--cell-size", "1", "--out", path("meshes"), "--particles-out", path("particles"),
                      "--stats", path("meshes/s.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(path("meshes/frame_000002.ply")));
    const nlohmann::json last = nlohmann::json::parse(formats::read_file(path("meshes/s.json"))).at("frames").at(2);
    const std::string label = "particle radius ";
    const std::size_t at = result.err.find(label);
    ASSERT_NE(at, std::string::npos) << result.err;
    const std::string radius = result.err.substr(at + label.size(), result.err.find('\n', at) - at - label.size());
    EXPECT_NEAR(std::stod(radius), 0.025 * std::cbrt(16000.0 / 500.0), 1e-6);
    const ProcessResult again =
        run_meniscus({"reconstruct", path("particles/frame_000002.vtk"), "--cell-size", "1", "--positions", "uint16",
                      "--particle-radius", radius, "--stats", path("again.json")});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(nlohmann::json::parse(formats::read_file(path("again.json"))).at("particles"), last.at("particles"));
}

TEST_F(Cli, WarnsInALineEachAndInTheFigures) {
    const ProcessResult result = run_meniscus(
        reconstruct({"-q", "--field", "density", "--cell-size", "2", "--iso", "9", "--stats", path("s.json")}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
    for (const std::string& words : {"meniscus: warning: " + in_ + ": the surface is empty: the greatest value",
                                     "meniscus: warning: " + in_ + ": finest cells of 1 are too large"})
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    const nlohmann::json warnings = nlohmann::json::parse(formats::read_file(path("s.json"))).at("warnings");
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_EQ(warnings[0].at("code"), "empty_surface");
    EXPECT_EQ(warnings[0].at("limit"), 9.0);
    EXPECT_EQ(warnings[1].at("code"), "cell_size_too_large");
    EXPECT_EQ(warnings[1].at("value"), 1.0);
    EXPECT_EQ(warnings[1].at("limit"), 0.75);
    EXPECT_NE(result.err.find(warnings[1].at("text").get<std::string>()), std::string::npos);
}

TEST_F(Cli, SaysNothingOfAFrameThatFitsHoweverStrict) {
    const ProcessResult result = run_meniscus(reconstruct({"-q", "--strict"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(stats({}).at("warnings"), nlohmann::json::array());
}

TEST_F(Cli, WhereStrictIsAskedForWarningsAreExitCode3AndAllIsWrittenAllTheSame) {
    const ProcessResult result =
        run_meniscus(reconstruct({"-q", "--cell-size", "2", "--strict", "--stats", path("s.json")}));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(formats::read_mesh(out_).triangles.empty());
    EXPECT_EQ(nlohmann::json::parse(formats::read_file(path("s.json"))).at("warnings").size(), 1U);

    const ProcessResult simulated =
        run_meniscus({"simulate", "--local", "--particles", "200", "--frames", "2", "--cell-size", "2", "--strict",
                      "--out", path("meshes"), "--stats", path("t.json")});
    EXPECT_EQ(simulated.exit_code, 3);
    EXPECT_NE(simulated.err.find("meniscus: warning: frame 1: finest cells"), std::string::npos) << simulated.err;
    EXPECT_TRUE(std::filesystem::exists(path("meshes/frame_000001.ply")));
    EXPECT_EQ(nlohmann::json::parse(formats::read_file(path("t.json"))).at("frames").size(), 2U);
}

TEST_F(Cli, ASequenceNamesTheFileThatAWarningIsAbout) {
    ParticleFrame frame;
    frame.positions = positions_;
    formats::write_vtk(directory_ / "f_1.vtk", frame);
    const std::vector<float> lone{0.0F, 0.0F, 0.0F};
    frame.positions = lone;
    formats::write_vtk(directory_ / "f_2.vtk", frame);
    const ProcessResult result =
        run_meniscus({"reconstruct", path("f_{}.vtk"), "-o", path("m_{}.ply"), "--particle-radius", "0.5", "--start",
                      "1", "--end", "2", "--repeat", "2", "--spray", "discard", "--strict"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("warning: " + path("f_2.vtk") + ": the surface is empty: the one particle lies alone"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(result.err.find("warning"), result.err.rfind("warning")) << result.err;
    EXPECT_TRUE(std::filesystem::exists(path("m_2.ply")));
}

TEST_F(Cli, WarnsOfAMeshThatIsTakenForParticles) {
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    const std::size_t faces = formats::read_mesh(out_).triangles.size();
    const ProcessResult result = run_meniscus({"reconstruct", out_, "-o", path("again.ply"), "--particle-radius", "0.2",
                                               "--strict", "--stats", path("s.json")});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("warning: " + out_ + ": the file has " + std::to_string(faces) + " faces"),
              std::string::npos)
        << result.err;
    EXPECT_TRUE(std::filesystem::exists(path("again.ply")));
    const nlohmann::json figures = nlohmann::json::parse(formats::read_file(path("s.json")));
    EXPECT_EQ(std::count_if(figures.at("warnings").begin(), figures.at("warnings").end(),
                            [&](const nlohmann::json& warning) {
                                return warning.at("code") == "faces_as_particles" && warning.at("value") == faces;
                            }),
              1);
}

TEST_F(Cli, ReconstructsRealFrames) {
    const auto folder = data_folder();
    if (!folder) GTEST_SKIP() << "MENISCUS_DATA is not set";
    const ProcessResult result =
        run_meniscus({"reconstruct", (*folder / "double_dam_break_with_sphere/frame_{}.vtk").string(), "--start", "20",
                      "--end", "21", "--particle-radius", "0.025", "--cell-size", "1", "--stats", path("s.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json frames = nlohmann::json::parse(formats::read_file(path("s.json"))).at("frames");
    ASSERT_EQ(frames.size(), 2U);
    for (const nlohmann::json& frame : frames) EXPECT_EQ(frame.at("particles"), 11492);
}

}  // namespace
}  // namespace meniscus::test
