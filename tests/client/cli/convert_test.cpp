// meniscus convert on files: particles and meshes from one format to another.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli_fixture.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/particles/particle_file.hpp"

namespace meniscus::test {
namespace {

class Convert : public Cli {
protected:
    /// Particles with levels, a velocity and an id.
    Convert() {
        std::string text =
            "ply\nformat ascii 1.0\nelement vertex 64\nproperty float x\nproperty float y\nproperty float z\nproperty "
            "uchar level\nproperty float vx\nproperty float vy\nproperty float vz\nproperty int id\nend_header\n";
        for (std::size_t i = 0; i < 64; ++i) {
            for (std::size_t a = 0; a < 3; ++a) text += std::to_string(positions_[3 * i + a]) + " ";
            text += std::to_string(i % 4) + " " + std::to_string(0.25 * static_cast<double>(i)) + " 0 -1 " +
                    std::to_string(1000 + i) + "\n";
        }
        particles_ = write("p.ply", text);
    }

    ProcessResult convert(const std::string& in, const std::string& out, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"convert", in, "-o", out});
        ProcessResult result = run_meniscus(more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    static void expect_same(const formats::Particles& a, const formats::Particles& b) {
        EXPECT_EQ(a.positions, b.positions);
        EXPECT_EQ(a.levels, b.levels);
        ASSERT_EQ(a.arrays.size(), b.arrays.size());
        for (std::size_t i = 0; i < a.arrays.size(); ++i) {
            EXPECT_EQ(a.arrays[i].name, b.arrays[i].name);
            EXPECT_EQ(a.arrays[i].type, b.arrays[i].type) << a.arrays[i].name;
            EXPECT_EQ(a.arrays[i].components, b.arrays[i].components);
            EXPECT_TRUE(a.arrays[i].data == b.arrays[i].data) << a.arrays[i].name;
        }
    }

    std::string particles_;
};

TEST_F(Convert, ParticlesKeepAllThatTheyCarryThroughEveryFormat) {
    const formats::Particles before = formats::read_particles(particles_);
    ASSERT_EQ(before.arrays.size(), 2U);
    std::string from = particles_;
    for (const char* name : {"a.npz", "b.vtk", "c.vtp", "d.ply"}) {
        const ProcessResult result = convert(from, path(name));
        EXPECT_EQ(result.err, from + ": 64 particles, " + path(name) + "\n");
        from = path(name);
        expect_same(formats::read_particles(from), before);
    }
    EXPECT_EQ(convert(particles_, path("q.ply"), {"-q"}).err, "");
}

TEST_F(Convert, MeshesAreToldByTheirFacesAndBecomeAnyFormat) {
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    const formats::TriangleMesh before = formats::read_mesh(out_);
    for (const char* name : {"a.obj", "b.vtk", "c.vtp", "d.npz", "e.ply"}) {
        EXPECT_EQ(convert(out_, path(name)).err,
                  out_ + ": " + std::to_string(before.triangles.size()) + " triangles, " + path(name) + "\n");
        const std::string back = path(std::string("back_") + name[0] + ".ply");
        convert(path(name), back);
        const formats::TriangleMesh after = formats::read_mesh(back);
        EXPECT_EQ(after.positions, before.positions) << name;
        EXPECT_EQ(after.triangles, before.triangles) << name;
        EXPECT_EQ(after.levels, before.levels) << name;
    }
    convert(out_, path("corners.vtk"), {"--particles"});
    EXPECT_EQ(formats::read_particles(path("corners.vtk")).count(), before.positions.size());
    convert(out_, path("mesh.obj"), {"--mesh"});
}

TEST_F(Convert, SequencesKeepTheirNumbers) {
    const std::string bytes = formats::read_file(in_);
    for (const char* name : {"f_08.xyz", "f_09.xyz", "f_10.xyz"}) write(name, bytes);
    convert(path("f_{}.xyz"), path("g_{}.npz"), {"--start", "9"});
    EXPECT_FALSE(std::filesystem::exists(path("g_08.npz")));
    for (const char* name : {"g_09.npz", "g_10.npz"})
        EXPECT_EQ(formats::read_particles(path(name)).positions, positions_);
}

TEST_F(Convert, PipesNeedNamesOfFormatsAndWhatIsInThem) {
    const ProcessResult piped =
        run_meniscus({"convert", "-", "--input-format", "xyz", "-o", "-", "--format", "ply", "-q"}, {.in = in_});
    ASSERT_EQ(piped.exit_code, 0) << piped.err;
    convert(in_, path("p2.ply"));
    EXPECT_TRUE(piped.out == formats::read_file(path("p2.ply")));
    expect_refused({"convert", "-", "-o", path("a.ply")}, {"--input-format"});
    expect_refused({"convert", in_, "-o", "-"}, {"--format"});
    const ProcessResult ply =
        run_meniscus({"convert", "-", "--input-format", "ply", "-o", path("a.vtk")}, {.in = particles_});
    EXPECT_EQ(ply.exit_code, 2);
    EXPECT_NE(ply.err.find("--particles or --mesh"), std::string::npos) << ply.err;
}

TEST_F(Convert, RefusesWhatItCannotMakeBeforeItWritesAnything) {
    ASSERT_EQ(run_meniscus(reconstruct({})).exit_code, 0);
    expect_refused({"convert", in_, "-o", path("a.xyz")}, {"ply, vtk, vtp or npz", "xyz"});
    expect_refused({"convert", in_, "-o", path("a.obj")}, {"ply, vtk, vtp or npz", "obj"});
    expect_refused({"convert", out_, "-o", path("a.bricks")}, {"bricks", "reconstruction"});
    expect_refused({"convert", in_, "-o", in_}, {"is the file of the input"});
    expect_refused({"convert", in_, "-o", path("none/a.ply")}, {"none"});
    expect_refused({"convert", in_, "-o", path("a_{}.ply")}, {"{}"});
    expect_refused({"convert", in_, "-o", path("a.ply"), "--start", "1"}, {"--start", "{}"});
    expect_refused({"convert", in_, "-o", path("a.ply"), "--from", "1"}, {"no recording", "--start"});
    expect_refused({"convert", in_, "--mesh", "-o", path("a.ply")}, {"xyz", "no mesh"});
    expect_refused({"convert", write("m.obj", "v 0 0 0\n"), "--particles", "-o", path("a.ply")},
                   {"obj", "no particles"});
    expect_refused({"convert", path("nothing.ply"), "-o", path("a.ply")}, {"nothing.ply", "no such file"});
    EXPECT_FALSE(std::filesystem::exists(path("a.ply")));
    // By its first line, whatever its name.
    expect_refused({"convert", write("x.ply", "Meniscus recording\n"), "-o", path("folder"), "--start", "1"},
                   {"x.ply is a recording", "--from"});
}

TEST_F(Convert, OfARecordingGoesToAFolderAndSaysSoWhereItIsGivenAFile) {
    const std::string recording = write("x.recording", "Meniscus recording\n");
    expect_refused({"convert", recording, "-o", path("y_{}.vtp")}, {"x.recording is a recording", "--format vtp"});
    expect_refused({"convert", recording, "-o", path("y_{}")}, {"is a folder", "-o FOLDER"});
    expect_refused({"convert", recording, "-o", path("y.PLY")}, {"is a folder", "y.PLY", "--format ply"});
    EXPECT_FALSE(std::filesystem::exists(path("y.PLY")));
    // One that is there has any name. The recording has no more than its first line.
    std::filesystem::create_directory(path("z.ply"));
    expect_refused({"convert", recording, "-o", path("z.ply")}, {"x.recording:"});
}

}  // namespace
}  // namespace meniscus::test
