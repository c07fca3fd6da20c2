// meniscus compare, as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare_shapes.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "process.hpp"
#include "sample_files.hpp"

namespace meniscus::compare {
namespace {

class CompareCommand : public testing::Test {
protected:
    std::string write(const std::string& name, const std::string& bytes) const {
        formats::write_file(directory_ / name, bytes);
        return (directory_ / name).string();
    }
    static test::ProcessResult run(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "compare");
        return test::run_process(MENISCUS_CLI, arguments);
    }
    static void expect_refused(const std::vector<std::string>& arguments, const std::string& words) {
        const test::ProcessResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << words;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
    }

    test::TemporaryDirectory directory_;
};

TEST_F(CompareCommand, WritesTheFiguresThatItPrints) {
    const std::string a = write("a.obj", cube().obj());
    const std::string b = write("b.obj", cube().add(square(), {0.0, 0.0, 3.0}).obj());
    const std::string json = (directory_ / "figures.json").string();
    const test::ProcessResult result =
        run({a, b, "--particle-radius", "4", "--cell-size", "0.5", "--samples", "1000", "--json", json});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* words : {"12 triangles", "14 triangles", "closed", "NOT CLOSED: 4 unbalanced edges", "max 2 (1 c)",
                              "lost       1 of 2", "gained     0 of 1"})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << " in: " << result.out;
    const auto figures = nlohmann::json::parse(formats::read_file(json));
    EXPECT_EQ(figures["distance"]["max"], 2.0);
    EXPECT_EQ(figures["distance"]["b_to_a"]["max"], 2.0);
    EXPECT_NEAR(figures["distance"]["a_to_b"]["max"].get<double>(), 0.0, 1e-12);
    EXPECT_EQ(figures["distance_in_cells"]["max"], 1.0);
    EXPECT_EQ(figures["triangle_ratio"], 12.0 / 14.0);
    EXPECT_EQ(figures["a"]["closed"], true);
    EXPECT_EQ(figures["b"]["closed"], false);
    EXPECT_EQ(figures["b"]["defects"]["unbalanced_edges"], 4);
    EXPECT_EQ(figures["lost"]["components"], 1);
    EXPECT_EQ(figures["lost"]["farthest_cells"], 1.0);
    EXPECT_EQ(figures["lost"]["parts"][0]["triangles"], 2);
    EXPECT_EQ(figures["gained"]["components"], 0);
}

TEST_F(CompareCommand, TakesTheCellsOfReconstructUnlessToldOtherwise) {
    const std::string a = write("a.obj", cube().obj());
    const std::string b = write("b.obj", cube().add(square(), {0.0, 0.0, 3.0}).obj());
    const auto figures = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {a, b, "--samples", "1000", "--json", "-"});
        const test::ProcessResult result = run(more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find("12 triangles"), std::string::npos) << result.err;
        return nlohmann::json::parse(result.out);
    };
    EXPECT_EQ(figures({"--particle-radius", "4"}), figures({"-r", "4", "-c", "0.5"}));
    EXPECT_EQ(figures({"-r", "4"})["cell_size"], 2.0);
}

TEST_F(CompareCommand, HasTheHashesOfBricksAsTheReconstructionHasThem) {
    std::string particles;
    for (int i = 0; i < 6 * 6 * 6; ++i)
        for (const int place : {i % 6, i / 6 % 6, i / 36}) {
            const float coordinate = 0.1F * static_cast<float>(place);
            particles.append(reinterpret_cast<const char*>(&coordinate), sizeof coordinate);
        }
    const std::string input = write("particles.xyz", particles);
    const auto reconstructed = [&](const std::string& name) {
        const std::string stats = (directory_ / "stats.json").string();
        const test::ProcessResult result =
            test::run_process(MENISCUS_CLI, {"reconstruct", input, "-r", "0.05", "-q", "--backend", "cpu", "--stats",
                                             stats, "-o", (directory_ / name).string()});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(formats::read_file(stats));
    };
    const auto stats = reconstructed("a.bricks");
    reconstructed("b.ply");
    const std::string json = (directory_ / "figures.json").string();
    const std::string a = (directory_ / "a.bricks").string();
    const test::ProcessResult result = run({a, (directory_ / "b.ply").string(), "--samples", "100", "--json", json});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto figures = nlohmann::json::parse(formats::read_file(json));
    for (const char* hash : {"mesh_sha256", "bricks_sha256"}) {
        ASSERT_EQ(stats.at(hash).get<std::string>().size(), 64U);
        EXPECT_EQ(figures["a"].at(hash), stats.at(hash));
        EXPECT_FALSE(figures["b"].contains(hash)) << "a file of triangles has no lattice";
        EXPECT_NE(result.out.find(hash + (" " + stats.at(hash).get<std::string>())), std::string::npos) << result.out;
    }
    const test::ProcessResult piped =
        test::run_process(MENISCUS_CLI, {"compare", "-", a, "--input-format", "bricks", "--samples", "100"}, {.in = a});
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    const std::size_t first = piped.out.find("bricks_sha256");
    EXPECT_NE(piped.out.find("bricks_sha256", first + 1), std::string::npos) << piped.out;
}

TEST_F(CompareCommand, ReadsOneMeshFromStandardInput) {
    const std::string a = write("a.obj", cube().obj());
    const std::string b = write("b.txt", cube().obj());
    const test::ProcessResult result =
        test::run_process(MENISCUS_CLI, {"compare", a, "-", "--input-format", "obj", "--samples", "1000"}, {.in = b});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("standard input: 12 triangles"), std::string::npos) << result.out;
}

TEST_F(CompareCommand, DoesNotDestroyWhatItReads) {
    const std::string a = write("a.obj", cube().obj());
    expect_refused({a, a, "--json", a}, "it is the file of the input");
    EXPECT_EQ(formats::read_file(a), cube().obj());
}

TEST_F(CompareCommand, SaysNothingInCellsWithoutACellSize) {
    const std::string a = write("a.obj", cube().obj());
    const std::string json = (directory_ / "figures.json").string();
    const test::ProcessResult result = run({a, a, "--json", json});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out.find("lost"), std::string::npos) << result.out;
    const auto figures = nlohmann::json::parse(formats::read_file(json));
    EXPECT_TRUE(figures.contains("distance"));
    EXPECT_FALSE(figures.contains("distance_in_cells"));
    EXPECT_FALSE(figures.contains("lost"));
}

TEST_F(CompareCommand, RefusesBadInputInOneLine) {
    const std::string good = write("good.obj", cube().obj());
    const std::string empty = write("empty.obj", "v 0 0 0\n");
    const std::string flat = write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const std::string vast = write("vast.obj", "v 0 0 0\nv 1e70 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_refused({good}, "B");
    expect_refused({good, (directory_ / "missing.ply").string()}, "missing.ply");
    expect_refused({empty, good}, "empty.obj: has no triangles, and 1 point: ");
    expect_refused({good, flat}, "flat.obj: a mesh whose triangles have no area");
    expect_refused({good, vast}, "vast.obj: vertex 1 has the coordinate 1e+70");
    expect_refused({good, write("mesh.stl", "")}, "mesh.stl");
    expect_refused({good, good, "--samples", "0"}, "--samples");
    for (const char* flag : {"--cell-size", "--particle-radius"})
        for (const char* size : {"0", "-1", "nan", "inf"})
            expect_refused({good, good, "--particle-radius", "1", flag, size}, flag);
    expect_refused({good, good, "--cell-size", "0.5"}, "--particle-radius");
    expect_refused({"-", "-", "--input-format", "obj"}, "standard input holds one mesh");
    expect_refused({"-", good}, "--input-format: ply, obj, bricks, vtk, vtp, vtu or npz");
    expect_refused({good, good, "--json", (directory_ / "none").string() + "/figures.json"}, "none");
}

}  // namespace
}  // namespace meniscus::compare
