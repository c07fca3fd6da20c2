#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/options/splashsurf.hpp"
#include "cli/print/settings_json.hpp"
#include "cli/print/statistics_json.hpp"
#include "cli/sequence/file_pattern.hpp"
#include "cli/surfaces/quantized_positions.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "meniscus/near_name.hpp"
#include "sample_files.hpp"

namespace meniscus::cli {
namespace {

TEST(FilePattern, ReplacesTheNumber) {
    EXPECT_EQ(FilePattern("a/frame_{}.vtk").at(7), "a/frame_7.vtk");
    EXPECT_EQ(FilePattern("frame_{:04}.vtk").at(7), "frame_0007.vtk");
    EXPECT_EQ(FilePattern("frame_{:02}.vtk").at(123), "frame_123.vtk");
    EXPECT_EQ(FilePattern("frame.vtk").at(123), "frame.vtk");
    EXPECT_FALSE(FilePattern("frame.vtk").has_number());
    EXPECT_FALSE(FilePattern("a{x}b{:0}c{:00}d{:03").has_number());
    EXPECT_EQ(FilePattern("a{x}b{:02}").at(7), "a{x}b07");
}

TEST(FilePattern, FindsThePaddingOfExistingFiles) {
    const test::TemporaryDirectory directory;
    formats::write_file(directory / "f_009.vtk", "");
    FilePattern pattern((directory / "f_{}.vtk").string());
    EXPECT_EQ(pattern.match_existing().at(9), directory / "f_009.vtk");
    EXPECT_EQ(pattern.at(9), directory / "f_009.vtk");
    EXPECT_EQ(pattern.at(10), directory / "f_010.vtk");
    FilePattern out("m_{}.ply");
    out.pad_like(pattern);
    EXPECT_EQ(out.at(9), "m_009.ply");
    FilePattern fixed("m_{:02}.ply");
    fixed.pad_like(pattern);
    EXPECT_EQ(fixed.at(9), "m_09.ply");
}

TEST(FilePattern, FindsAllNumbersInTheirOrderAndNothingElse) {
    const test::TemporaryDirectory directory;
    for (const char* name : {"f_9.vtk", "f_10.vtk", "f_100.vtk", "f_.vtk", "f_1x.vtk", "f_-1.vtk", "f_2.ply", "g_3.vtk",
                             "f_99999999999999999999999.vtk"})
        formats::write_file(directory / name, "");
    const auto numbers = [](FilePattern pattern) {
        std::vector<std::uint64_t> all;
        for (const auto& [number, path] : pattern.match_existing()) {
            EXPECT_TRUE(std::filesystem::exists(path)) << path;
            all.push_back(number);
        }
        return all;
    };
    const auto in_folder = [&](const char* name) { return FilePattern((directory / name).string()); };
    EXPECT_EQ(numbers(in_folder("f_{}.vtk")), (std::vector<std::uint64_t>{9, 10, 100}));
    EXPECT_EQ(numbers(in_folder("f_{:02}.vtk")), (std::vector<std::uint64_t>{10, 100}));
    EXPECT_TRUE(numbers(in_folder("no/such/folder/f_{}.vtk")).empty());
    formats::make_directory(directory / "run_7");
    formats::write_file(directory / "run_7/frame.vtk", "");
    formats::make_directory(directory / "run_8");
    EXPECT_EQ(numbers(in_folder("run_{}/frame.vtk")), (std::vector<std::uint64_t>{7}));
}

TEST(FilePattern, RefusesTwoFilesOfOneNumber) {
    const test::TemporaryDirectory directory;
    for (const char* name : {"f_7.vtk", "f_007.vtk"}) formats::write_file(directory / name, "");
    const std::string refused = test::refusal([&] { FilePattern((directory / "f_{}.vtk").string()).match_existing(); });
    for (const char* word : {"f_7.vtk", "f_007.vtk", "{:0W}"})
        EXPECT_NE(refused.find(word), std::string::npos) << refused;
    EXPECT_EQ(FilePattern((directory / "f_{:03}.vtk").string()).match_existing().size(), 1U);
}

TEST(NearName, IsTheOneWithTheFewestChangesIfThoseAreFew) {
    const std::vector<std::string> names{"particle-radius", "particles", "cell-size", "iso", "field"};
    EXPECT_EQ(near_name("particel-radius", names), "particle-radius");
    EXPECT_EQ(near_name("particle-radis", names), "particle-radius");
    EXPECT_EQ(near_name("cellsize", names), "cell-size");
    EXPECT_EQ(near_name("cell", names), "cell-size");
    EXPECT_EQ(near_name("feild", names), "field");
    EXPECT_EQ(near_name("ios", names), "iso");
    for (const char* far : {"", "x", "frobnicate", "threads"}) EXPECT_EQ(near_name(far, names), "") << far;
}

/// A cell of a table in Markdown as its words alone.
std::string words_of_cell(std::string cell) {
    std::erase(cell, '`');
    for (std::size_t open = cell.find("]("); open != std::string::npos; open = cell.find("]("))
        cell.erase(open, cell.find(')', open) + 1 - open);
    std::erase(cell, '[');
    const std::size_t first = cell.find_first_not_of(' ');
    return first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') + 1 - first);
}

TEST(Splashsurf, HasTheRowsOfTheDocument) {
    std::ifstream document(MENISCUS_CLIENT_DOCUMENT);
    std::string line;
    while (std::getline(document, line) && !line.starts_with("| splashsurf | Meniscus |")) continue;
    std::getline(document, line);
    for (const SplashsurfRow& row : splashsurf_rows) {
        ASSERT_TRUE(std::getline(document, line));
        std::vector<std::string> cells;
        std::istringstream text(line.substr(1));
        for (std::string cell; std::getline(text, cell, '|');) cells.push_back(words_of_cell(cell));
        EXPECT_EQ(cells, (std::vector<std::string>{std::string(row.options), std::string(row.here),
                                                   std::string(row.differs)}));
    }
    EXPECT_TRUE(std::getline(document, line) && line.empty()) << line;
}

TEST(Splashsurf, IsAnsweredByTheRowOfTheOption) {
    EXPECT_EQ(splashsurf_option("reconstruct", "-n"), "here --threads");
    EXPECT_EQ(splashsurf_option("reconstruct", "-n4"), "here --threads");
    EXPECT_EQ(splashsurf_option("reconstruct", "--output-dir"), "the folder is part of -o");
    EXPECT_EQ(splashsurf_option("reconstruct", "--subdomain-cubes"), "work and memory follow the surface");
    EXPECT_EQ(splashsurf_option("convert", "--domain-max"), "here reconstruct --particle-aabb");
    EXPECT_EQ(splashsurf_option("reconstruct", "--domain-max"), "");
    EXPECT_EQ(splashsurf_option("reconstruct", "--subdomain"), "");
    EXPECT_EQ(splashsurf_option("reconstruct", "--num-thread"), "");
    EXPECT_EQ(splashsurf_option("reconstruct", "-domain"), "");
}

TEST(FilePattern, NamesItsOwnNotationForASequenceInAnother) {
    const test::TemporaryDirectory directory;
    const auto refused = [](const std::string& text) {
        return test::refusal([&] { FilePattern(text).require_no_other_notation(); });
    };
    EXPECT_NE(refused("a/frame_*.vtk").find("as 'a/frame_{}.vtk'"), std::string::npos);
    EXPECT_NE(refused("frame_%04d.vtk").find("as 'frame_{:04}.vtk'"), std::string::npos);
    EXPECT_NE(refused("frame_%d.vtk").find("as 'frame_{}.vtk'"), std::string::npos);
    EXPECT_NE(refused("frame_%6d.vtk").find("as 'frame_{}.vtk'"), std::string::npos);
    for (const char* other : {"frame.vtk", "frame_{}_*.vtk", "50%.vtk", "50%", "%x.vtk", "-"})
        EXPECT_NO_THROW(FilePattern(other).require_no_other_notation()) << other;
    formats::write_file(directory / "a*b.vtk", "");
    EXPECT_NO_THROW(FilePattern((directory / "a*b.vtk").string()).require_no_other_notation());
}

TEST(QuantizedPositions, AreWithinHalfAStepAndExactAtTheCorners) {
    const std::vector<float> positions{-1.0F, 5.0F, 2.0F, 3.0F, 5.0F, 2.5F, 0.123F, 5.0F, 2.2F};
    ParticleFrame frame;
    frame.positions = positions;
    const QuantizedPositions quantized(frame);
    const ParticleFrame view = quantized.frame();
    ASSERT_EQ(view.count(), 3U);
    const Box box = view.quantization_box;
    for (std::size_t i = 0; i < 9; ++i) {
        const double extent = box.max[i % 3] - box.min[i % 3];
        const double back = box.min[i % 3] + view.quantized[i] * extent / 65535.0;
        EXPECT_NEAR(back, static_cast<double>(positions[i]), 0.5 * extent / 65535.0 + 1e-12);
    }
    EXPECT_EQ(view.quantized[0], 0U);
    EXPECT_EQ(view.quantized[3], 65535U);
    EXPECT_EQ(view.quantized[1], 0U);  // a flat axis
}

TEST(SettingsAsJson, HaveEveryKeyWhateverIsChosen) {
    Settings settings;
    const auto keys = [](const nlohmann::ordered_json& json) {
        std::vector<std::string> all;
        for (const auto& [key, value] : json.items()) all.push_back(key);
        return all;
    };
    const nlohmann::ordered_json defaults = to_json(settings);
    EXPECT_EQ(keys(defaults),
              (std::vector<std::string>{"particle_radius", "cell_size", "iso", "field", "smoothness", "spray",
                                        "smoothing_length", "mode", "criterion", "tolerance", "count_threshold",
                                        "edge_points", "bisection_steps", "normals", "attributes"}));
    settings.criterion = CountCriterion{4};
    settings.edge_points = Bisection{3};
    const nlohmann::ordered_json others = to_json(settings);
    EXPECT_EQ(keys(others), keys(defaults));
    EXPECT_EQ(others["criterion"], "count");
    EXPECT_EQ(others["tolerance"], defaults["tolerance"]);
    EXPECT_EQ(others["count_threshold"], 4);
    EXPECT_EQ(others["edge_points"], "bisect");
    EXPECT_EQ(others["bisection_steps"], 3);
}

TEST(SettingsAsJson, NameWhatIsInForce) {
    Settings settings;
    settings.field = Field::smooth;
    settings.smoothness = 7;
    settings.spray = Spray::points;
    const nlohmann::ordered_json smooth = to_json(settings);
    EXPECT_EQ(smooth["field"], "smooth");
    EXPECT_EQ(smooth["smoothness"], 7);
    EXPECT_EQ(smooth["spray"], "points");
    EXPECT_EQ(smooth["tolerance"], tolerance(settings));
    Settings color;
    color.field = Field::color;
    color.smoothing_length = 1.5;
    EXPECT_EQ(to_json(color)["smoothing_length"], 1.5);
    EXPECT_EQ(to_json(color)["tolerance"], tolerance(color));
}

TEST(Statistics, ReportTheMedianWarmRunAndTheColdOne) {
    std::vector<Statistics> runs(4);
    runs[0].total_seconds = 9.0;
    runs[1].total_seconds = 3.0;
    runs[2].total_seconds = 1.0;
    runs[3].total_seconds = 2.0;
    EXPECT_EQ(median_run(runs).total_seconds, 2.0);
    EXPECT_EQ(to_json(runs, {}).at("first_seconds"), 9.0);
    runs.resize(1);
    EXPECT_EQ(median_run(runs).total_seconds, 9.0);
    runs.resize(3);
    runs[1].total_seconds = 4.0;
    runs[2].total_seconds = 3.0;
    EXPECT_EQ(median_run(runs).total_seconds, 3.0);
}

}  // namespace
}  // namespace meniscus::cli
