// meniscus publish: from files, going on, as a site and as one page; and what convert, check and picture make of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cli_fixture.hpp"
#include "viewer_files.hpp"

namespace meniscus::test {
namespace {

class Publish : public Cli {
protected:
    static constexpr int frame_count = 6;

    /// Frames 10 to 15, each of which has a particle more than the one before.
    Publish() {
        for (int i = 0; i < frame_count; ++i) {
            std::string bytes;
            for (std::size_t v = 0; v < positions_.size() - 3 * static_cast<std::size_t>(frame_count - i); ++v)
                formats::store(bytes, positions_[v]);
            write("f_" + std::to_string(10 + i) + ".xyz", bytes);
        }
    }

    std::vector<std::string> publish(const std::string& to, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"publish", path("f_{}.xyz"), "--to", path(to), "-r", "0.5", "--backend", "cpu"});
        return more;
    }
    nlohmann::json manifest(const std::string& folder) const {
        return nlohmann::json::parse(formats::read_file(path(folder + "/manifest.json")));
    }
    static void expect_done(const std::vector<std::string>& arguments) {
        const ProcessResult result = run_meniscus(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    std::string converted(const std::string& folder, int frame) const {
        return formats::read_file(path(folder + "/frame_0000" + std::to_string(frame) + ".ply"));
    }
};

TEST_F(Publish, GivesTheMeshesThatReconstructWrites) {
    expect_done(publish("site"));
    expect_done({"convert", path("site"), "-o", path("meshes")});
    expect_done({"reconstruct", path("f_{}.xyz"), "-o", path("m_{}.ply"), "-r", "0.5", "--backend", "cpu",
                 "--normal-bits", "8"});
    for (int i = 10; i < 10 + frame_count; ++i)
        EXPECT_TRUE(converted("meshes", i) == formats::read_file(path("m_" + std::to_string(i) + ".ply"))) << i;
    EXPECT_EQ(manifest("site")["frames"], "6");
    EXPECT_EQ(manifest("site")["live"], false);
}

TEST_F(Publish, GoesOnWithFramesThatAreNotThereYet) {
    expect_done(publish("site", {"--end", "12"}));
    const std::string first = manifest("site")["segments"][0]["sha256"];
    const ProcessResult result = run_meniscus(publish("site"));
    EXPECT_NE(result.err.find("6 frames in 2 segments"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("3 were there before"), std::string::npos) << result.err;
    EXPECT_EQ(manifest("site")["segments"][0]["sha256"], first);
    expect_refused(publish("site", {"-c", "1"}), {"other settings"});
}

TEST_F(Publish, IsConvertedInShares) {
    expect_done(publish("site"));
    expect_done({"convert", path("site"), "-o", path("whole")});
    for (const char* const share : {"1/2", "2/2"})
        expect_done({"convert", path("site"), "-o", path("shared"), "--share", share});
    for (int i = 10; i < 10 + frame_count; ++i) EXPECT_TRUE(converted("shared", i) == converted("whole", i)) << i;
    const std::vector<std::string> none{"convert", path("site"), "-o", path("none"), "--share", "1/2", "--from", "90"};
    expect_refused(none, {"no mesh of a frame", "90"});
}

TEST_F(Publish, IsNotSharedOutWhileItGrowsOrWhereFramesOfSeveralRunsHaveOneName) {
    expect_done(publish("site", {"--end", "12"}));
    expect_done(publish("site"));
    nlohmann::json changed = manifest("site");
    const auto convert = [&](const nlohmann::json& text) {
        formats::write_file(path("site/manifest.json"), text.dump());
        return std::vector<std::string>{"convert", path("site"), "-o", path("shared"), "--share", "1/2"};
    };
    changed["live"] = true;
    expect_refused(convert(changed), {"--share", "more frames may come"});
    changed["live"] = false;
    changed["segments"][1]["run_id"] = "7";
    expect_refused(convert(changed), {"--share", "several runs"});
}

TEST_F(Publish, TakesTheFramesThatAreWantedInTheFormThatIsWanted) {
    expect_done(publish("all"));
    expect_done(publish("some", {"--every", "2", "--start", "11", "--frame-rate", "10", "--normals-by", "receiver",
                                 "--name", "dam", "--up-axis", "z"}));
    const nlohmann::json some = manifest("some");
    EXPECT_EQ(some["frames"], "2");
    EXPECT_EQ(some["segments"][0]["first_frame"], "12");
    EXPECT_EQ(some["segments"][0]["last_time"], 1.4);
    EXPECT_EQ(some["normals_by_receiver"], true);
    EXPECT_EQ(some["description"]["name"], "dam");
    EXPECT_LT(std::stol(some["bytes"].get<std::string>()), std::stol(manifest("all")["bytes"].get<std::string>()) / 3);
    const ProcessResult mesh = run_meniscus({"convert", path("some"), "-o", path("meshes"), "--from", "14"});
    EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
    EXPECT_NE(converted("meshes", 14).find("property float nx"), std::string::npos);
}

TEST_F(Publish, ACoarserFormIsClosedAndSmaller) {
    expect_done(publish("fine"));
    expect_done(publish("coarse", {"--max-level", "2", "--position-bits", "3", "--normal-bits", "4"}));
    EXPECT_LT(std::stol(manifest("coarse")["bytes"].get<std::string>()),
              std::stol(manifest("fine")["bytes"].get<std::string>()));
    expect_done({"check", path("coarse")});
}

TEST_F(Publish, FilesOfBricksArePublishedAsTheyAre) {
    expect_done({"reconstruct", path("f_{}.xyz"), "-o", path("b_{}.bricks"), "-r", "0.5", "--backend", "cpu"});
    for (const char* const end : {"12", "15"})  // goes on
        expect_done({"publish", path("b_{}.bricks"), "--to", path("site"), "--end", end});
    expect_done(publish("direct"));
    for (const std::string folder : {"site", "direct"})
        expect_done({"convert", path(folder), "-o", path(folder + "_m")});
    for (int i = 10; i < 10 + frame_count; ++i) EXPECT_TRUE(converted("site_m", i) == converted("direct_m", i)) << i;
    expect_refused({"publish", path("b_{}.bricks"), "--to", path("other"), "--max-level", "2"}, {"as they are"});
    expect_refused({"publish", path("b_{}.bricks"), "--to", path("other"), "-r", "0.5"}, {"whose surface is made"});
}

TEST_F(Publish, IsCheckedAndDrawnFrameByFrame) {
    expect_done(publish("site"));
    const ProcessResult all = run_meniscus({"check", path("site")});
    EXPECT_EQ(std::count(all.out.begin(), all.out.end(), '\n'), frame_count) << all.out;
    const ProcessResult one = run_meniscus({"check", path("site"), "--frame", "13"});
    EXPECT_NE(one.out.find("frame 13: "), std::string::npos) << one.out;
    EXPECT_EQ(std::count(one.out.begin(), one.out.end(), '\n'), 1) << one.out;
    expect_done({"picture", path("site"), "--frame", "13", "-o", path("p.png"), "--width", "64", "--height", "64"});
    EXPECT_TRUE(std::filesystem::exists(path("p.png")));
    expect_refused({"picture", path("site"), "--frame", "99", "-o", path("q.png")}, {"no mesh of a frame 99"});
    expect_refused({"picture", in_, "--frame", "1", "-o", path("q.png")}, {"--frame is of a recording"});
}

TEST_F(Publish, WhatCannotBePublishedIsRefused) {
    expect_refused({"publish", path("f_{}.xyz"), "--to", path("site")}, {"--particle-radius is needed"});
    expect_refused(publish("site", {"--every", "7", "--end", "13"}), {"multiple of 7"});
    expect_refused({"publish", path("nothing.vtk"), "--to", path("site"), "-r", "1"}, {"nothing.vtk"});
    expect_refused(publish("site", {"--every", "0"}), {"--every"});
    expect_done(publish("there"));
    expect_refused({"publish", path("there"), "--to", path("site")}, {"a publication already"});
    expect_refused({"convert", path("there"), "-o", path("m.ply")}, {"OUT is a folder"});
    expect_refused({"convert", path("there"), "-o", path("m"), "--particles"}, {"no particles"});
}

TEST_F(Publish, IsAWebSiteOrOnePage) {
    if (viewer::single_page().empty()) {
        expect_refused(publish("site", {"--page"}), {"built without the viewer"});
        return;
    }
    expect_done(publish("site", {"--page"}));
    const std::string page = formats::read_file(path("site/index.html"));
    EXPECT_NE(page.find("<meta name=\"meniscus-publication\" content=\"./\" />"), std::string::npos);
    EXPECT_NE(page.find("Content-Security-Policy"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_directory(path("site/assets")));

    expect_done(publish("one.html", {"--single-file"}));
    const std::string one = formats::read_file(path("one.html"));
    EXPECT_NE(one.find("data-file=\"manifest.json\""), std::string::npos);
    const std::size_t data = one.find(".segment\">");
    EXPECT_NE(data, std::string::npos);
    EXPECT_LT(data, one.rfind("</body>"));
    EXPECT_FALSE(std::filesystem::exists(path("one.html.parts")));
    expect_refused(publish("none/one.html", {"--single-file"}), {"there is no folder"});
}

}  // namespace
}  // namespace meniscus::test
