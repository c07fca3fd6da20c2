// Boxes and origins of meniscus reconstruct, the forms of the meshes that it writes, their checks, the limit of inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_fixture.hpp"
#include "formats/meshes/mesh_file.hpp"

namespace meniscus::test {
namespace {

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
