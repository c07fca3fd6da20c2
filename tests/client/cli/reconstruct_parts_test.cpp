// A frame that is reconstructed in parts: the files of the whole, to the byte.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_fixture.hpp"

namespace meniscus::test {
namespace {

class CliReconstructParts : public Cli {
protected:
    /// In some 20 bricks. Returns the figures.
    nlohmann::json run(const std::string& out, std::vector<std::string> more) const {
        more.insert(more.begin(), {"reconstruct", in_, "-o", path(out), "--particle-radius", "0.5", "--cell-size",
                                   "0.1", "--stats", path("stats.json")});
        const ProcessResult result = run_meniscus(more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(formats::read_file(path("stats.json")));
    }
};

TEST_F(CliReconstructParts, GivesTheFilesAndFiguresOfTheWhole) {
    const nlohmann::json whole = run("whole.ply", {"--parts", "1"});
    for (const char* const parts : {"2", "8", "40"}) {
        SCOPED_TRACE(parts);
        const nlohmann::json figures = run("parts.ply", {"--parts", parts, "--check"});
        EXPECT_EQ(formats::read_file(path("parts.ply")), formats::read_file(path("whole.ply")));
        for (const char* const name : {"mesh_sha256", "bricks_sha256", "particles", "vertices", "triangles",
                                       "triangles_by_level", "base_cells_by_level", "volume", "warnings"})
            EXPECT_EQ(figures.at(name), whole.at(name)) << name;
    }
}

TEST_F(CliReconstructParts, EncodesTheBricksOfTheWhole) {
    const nlohmann::json whole = run("whole.bricks", {});
    for (const char* const codec : {"entropy", "packed"}) {
        const nlohmann::json figures = run("parts.bricks", {"--parts", "6", "--codec", codec});
        EXPECT_EQ(figures.at("mesh_sha256"), whole.at("mesh_sha256"));
        EXPECT_EQ(figures.at("vertices"), whole.at("vertices"));
        for (const char* const name : {"whole", "parts"}) {
            const ProcessResult result =
                run_meniscus({"convert", path(name + std::string(".bricks")), "-o", path(name + std::string(".ply"))});
            ASSERT_EQ(result.exit_code, 0) << result.err;
        }
        EXPECT_EQ(formats::read_file(path("parts.ply")), formats::read_file(path("whole.ply")));
    }
}

TEST_F(CliReconstructParts, RefusesWhatPartsCannotDo) {
    expect_refused(reconstruct({"--parts", "0"}), {"--parts", "65536"});
    expect_refused(
        {"reconstruct", in_, "-o", path("mesh.bricks"), "-r", "0.5", "--parts", "2", "--attribute-bits", "8"},
        {"--attribute-bits", "--parts"});
    expect_refused(reconstruct({"--parts", "2", "--server", "localhost"}), {"--parts", "--server"});
}

}  // namespace
}  // namespace meniscus::test
