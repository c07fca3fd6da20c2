// The ranks of a job write files that together are the surface of one process, and list the frames that are whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "formats/meshes/mesh_file.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/meniscus.hpp"
#include "ranks/parts_job.hpp"
#include "ranks/surface_list.hpp"
#include "sample_files.hpp"
#include "support/particles.hpp"
#include "support/refusal.hpp"
#include "support/thread_exchange.hpp"

namespace meniscus::test {
namespace {

using formats::TriangleMesh;
using text_options::Options;
using Vertex = std::array<double, 7>;  ///< its place, its normal and its height
using Corners = std::array<Vertex, 3>;

/// The triangles, each with its least corner first, in order.
std::vector<Corners> triangles_of(const TriangleMesh& mesh, std::vector<Corners> others = {}) {
    if (mesh.triangles.empty()) return others;  // a part may have none
    const auto* const heights = reinterpret_cast<const float*>(mesh.attributes.at(0).data.data());
    const auto vertex = [&](std::uint32_t i) {
        std::array<double, 3> at = mesh.positions[i];
        if (!mesh.wide)
            for (double& x : at) x = static_cast<float>(x);
        const Normal& n = mesh.normals[i];
        return Vertex{at[0], at[1], at[2], n[0], n[1], n[2], heights[i]};
    };
    for (const Triangle& triangle : mesh.triangles) {
        Corners corners{vertex(triangle[0]), vertex(triangle[1]), vertex(triangle[2])};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        others.push_back(corners);
    }
    std::sort(others.begin(), others.end());
    return others;
}

/// What a list says of each of its files.
struct Listed {
    std::string time;
    std::string part;
    std::string file;
};
std::vector<Listed> read_list(const std::filesystem::path& path) {
    std::vector<Listed> all;
    std::ifstream file(path);
    const auto value = [](const std::string& line, const std::string& name) {
        const std::size_t begin = line.find(name + "=\"") + name.size() + 2;
        return line.substr(begin, line.find('"', begin) - begin);
    };
    for (std::string line; std::getline(file, line);)
        if (line.find("<DataSet") != std::string::npos)
            all.push_back({value(line, "timestep"), value(line, "part"), value(line, "file")});
    return all;
}

class RankFiles : public testing::Test {
protected:
    Options options(Options more = {}) const {
        more.insert({{"particle-radius", "0.025"},
                     {"cell-size", "0.25"},
                     {"threads", "1"},
                     {"policy", "every-frame"},
                     {"attribute", "height"},
                     {"reconstruct-ranks", "all"}});
        if (!more.contains("server")) more.try_emplace("output", folder_.string());
        return more;
    }
    Particles frame_of(std::uint64_t index) const {
        Particles particles = splash(static_cast<unsigned>(index), 8);
        for (std::size_t i = 0; i < particles.count(); ++i) particles.positions[3 * i] += east_;
        return particles;
    }
    static ParticleFrame with_heights(const Particles& particles, std::vector<float>& heights,
                                      std::vector<ParticleArray>& arrays) {
        for (std::size_t i = 0; i < particles.count(); ++i) heights.push_back(particles.positions[3 * i + 2]);
        arrays = {{"height", std::as_bytes(std::span(heights)), ElementType::float32, 1}};
        ParticleFrame frame = particles.frame();
        frame.arrays = arrays;
        return frame;
    }
    /// A rank's, dealt at random.
    void push(ranks::PartsJob& job, const PartExchange& exchange, std::uint64_t index, double time) const {
        const Particles all = frame_of(index);
        std::mt19937 random(static_cast<unsigned>(index));
        Particles mine;
        for (std::size_t i = 0; i < all.count(); ++i)
            if (random() % exchange.ranks() == exchange.rank())
                mine.add(all.positions[3 * i], all.positions[3 * i + 1], all.positions[3 * i + 2]);
        std::vector<float> heights;
        std::vector<ParticleArray> arrays;
        const ParticleFrame frame = with_heights(mine, heights, arrays);
        EXPECT_TRUE(job.push([&] { return frame; }, index, time));
    }
    std::vector<Corners> triangles_of_whole(std::uint64_t index) const {
        Settings settings = default_settings();
        settings.cell_size = 0.25;
        settings.attributes = {"height"};
        const Particles all = frame_of(index);
        std::vector<float> heights;
        std::vector<ParticleArray> arrays;
        return triangles_of(formats::to_triangles(reconstruct(settings, with_heights(all, heights, arrays))));
    }
    std::vector<Listed> list() const { return read_list(folder_ / "surface.pvd"); }
    /// Why a job of one rank cannot be opened.
    std::string refused(const Options& more) const {
        AloneExchange alone;
        return refusal([&] { ranks::PartsJob(alone, true, options(more)); });
    }

    /// Frames 5 to 7 by all ranks.
    void make(std::size_t ranks) const {
        on_ranks(ranks, [&](PartExchange& exchange) {
            ranks::PartsJob job(exchange, exchange.rank() == 0, options());
            EXPECT_EQ(job.session_id(), "");
            for (std::uint64_t index = 5; index < 8; ++index)
                push(job, exchange, index, .25 * static_cast<double>(index));
            job.finish();
        });
    }
    void expect_whole(std::size_t ranks) const {
        std::map<std::string, std::vector<Corners>> frames;
        for (const Listed& listed : list())
            frames[listed.time] = triangles_of(formats::read_mesh(folder_ / listed.file), frames[listed.time]);
        ASSERT_EQ(frames.size(), 3U);
        EXPECT_EQ(list().size(), 3 * ranks);
        EXPECT_TRUE(frames["1.25"] == triangles_of_whole(5));
        EXPECT_TRUE(frames["1.5"] == triangles_of_whole(6));
        EXPECT_TRUE(frames["1.75"] == triangles_of_whole(7));
    }

    float east_ = 0.0F;
    TemporaryDirectory directory_;
    std::filesystem::path folder_ = directory_ / "surfaces/of <all> & \"more\"";
};

TEST_F(RankFiles, AreTogetherTheSurfaceOfOneProcess) {
    for (const std::size_t ranks : {1, 3, 4}) {
        folder_ = directory_ / ("of-" + std::to_string(ranks));
        make(ranks);
        expect_whole(ranks);
    }
}

// Beyond 2^23 lattice units float32 does not do, and parts on either side of that have one border.
TEST_F(RankFiles, OfOneFrameHaveOnePrecision) {
    east_ = 819.0F;
    make(3);
    expect_whole(3);
    EXPECT_EQ(formats::read_mesh(folder_ / list()[0].file).wide, formats::read_mesh(folder_ / list()[2].file).wide);
}

TEST_F(RankFiles, AreListedByNumberWhereTimesDoNotIncrease) {
    AloneExchange alone;
    ranks::PartsJob job(alone, true, options());
    for (const std::uint64_t index : {2, 3, 70}) push(job, alone, index, 1.0);
    job.finish();
    ASSERT_EQ(list().size(), 3U);
    EXPECT_EQ(list()[0].time, "2");
    EXPECT_EQ(list()[2].time, "70");
    EXPECT_EQ(list()[2].part, "0");
    EXPECT_EQ(list()[2].file, "surface-000070-part-0.vtp");
}

// The last rank's part of frame 1 cannot be written.
TEST_F(RankFiles, OfAFrameThatLacksAPartAreNotListedAndDoNotStay) {
    constexpr std::size_t ranks = 3;
    std::filesystem::create_directories(folder_ / "surface-000001-part-2.vtp/in-the-way");
    std::set<std::string> listed;
    on_ranks(ranks, [&](PartExchange& exchange) {
        ranks::PartsJob job(exchange, exchange.rank() == 0, options());
        push(job, exchange, 0, 0.0);
        push(job, exchange, 1, 1.0);
        push(job, exchange, 2, 2.0);  // publishes frame 1
        const std::string told = refusal<ProcessFailed>([&] { push(job, exchange, 3, 3.0); });
        EXPECT_NE(told.find("part-2.vtp: cannot be written: it is a directory"), std::string::npos) << told;
        EXPECT_EQ(told.substr(0, 5), "rank ");
        // The pause.
        std::uint64_t index = 4;
        const Particles none;
        while (!job.push([&] { return none.frame(); }, index, static_cast<double>(index))) ++index;
        push(job, exchange, index + 1, static_cast<double>(index + 1));
        job.finish();
    });
    for (const Listed& entry : list()) listed.insert(entry.file);
    EXPECT_TRUE(listed.contains("surface-000000-part-0.vtp"));
    EXPECT_EQ(listed.size() % ranks, 0U);
    EXPECT_GT(listed.size(), 2 * ranks);
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (entry.is_regular_file()) files.insert(entry.path().filename());
    listed.insert("surface.pvd");
    EXPECT_EQ(files, listed);
}

// The frame before the last one cannot be written, which finish() tells.
TEST_F(RankFiles, OfTheLastFrameAreThereWhereTheFrameBeforeItHasFailed) {
    std::filesystem::create_directories(folder_ / "surface-000001-part-1.vtp/in-the-way");
    on_ranks(2, [&](PartExchange& exchange) {
        ranks::PartsJob job(exchange, exchange.rank() == 0, options());
        for (std::uint64_t index = 0; index < 3; ++index) push(job, exchange, index, static_cast<double>(index));
        const std::string told = refusal<ProcessFailed>([&] { job.finish(); });
        EXPECT_NE(told.find("surface-000001-part-1.vtp"), std::string::npos) << told;
    });
    ASSERT_EQ(list().size(), 4U);
    EXPECT_EQ(list()[1].file, "surface-000000-part-1.vtp");
    EXPECT_EQ(list()[3].file, "surface-000002-part-1.vtp");
    EXPECT_TRUE(std::filesystem::exists(folder_ / list()[3].file));
}

TEST_F(RankFiles, OfFramesBeforeOneThatCannotBeMadeAreListed) {
    AloneExchange alone;
    ranks::PartsJob job(alone, true, options({{"memory-limit", "4000000"}, {"attribute", ""}}));
    const Particles small = frame_of(0);
    for (std::uint64_t index = 0; index < 2; ++index)
        EXPECT_TRUE(job.push([&] { return small.frame(); }, index, static_cast<double>(index)));
    const Particles large = splash(1, 60);
    EXPECT_TRUE(job.push([&] { return large.frame(); }, 2, 2.0));
    EXPECT_NE(refusal<LimitExceeded>([&] { job.finish(); }), "");
    EXPECT_EQ(list().size(), 2U);
}

TEST_F(RankFiles, OfOneJobAreTheFoldersOnlyOnes) {
    AloneExchange alone;
    {
        const ranks::PartsJob first(alone, true, options());
        EXPECT_NE(refused({}).find("surface.pvd is there: name a folder without one"), std::string::npos);
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "surface.pvd"));  // it has no frames
    const ranks::SurfaceList list(folder_, 7);
    EXPECT_TRUE(ranks::SurfaceList::is_in(folder_, 7));
    EXPECT_FALSE(ranks::SurfaceList::is_in(folder_, 8));
    EXPECT_FALSE(ranks::SurfaceList::is_in(directory_.path(), 7));
}

TEST_F(RankFiles, OfAJobThatEndsWithoutAnErrorOfItsOwnAreListedAsFarAsTheyAreKnown) {
    AloneExchange alone;
    {
        ranks::PartsJob job(alone, true, options());
        for (std::uint64_t index = 0; index < 4; ++index) push(job, alone, index, static_cast<double>(index));
    }
    EXPECT_EQ(list().size(), 2U);  // the third is published, which no other call has confirmed; the fourth is not
}

TEST_F(RankFiles, AreRefusedWhereAListIsOrAServerIsNamed) {
    EXPECT_EQ(refused({{"server", "localhost:1"}, {"output", "x"}}),
              "rank 0: options 'server' and 'output' are both set, must be one of them");
    EXPECT_EQ(refused({{"output", ""}}),
              "rank 0: option 'server' is not set, must be HOST:PORT; or 'output', a folder of files");
    EXPECT_EQ(refused({{"codec", "draco"}}),
              "rank 0: option 'codec' is of servers, and 'output' writes files: leave it out");
    EXPECT_EQ(refused({{"timeout", "3"}}),
              "rank 0: option 'timeout' is of servers, and 'output' writes files: leave it out");
    EXPECT_EQ(
        refused({{"spray", "points"}}),
        "rank 0: option 'spray' is 'points', which the files of 'output' have no place for: must be keep or discard");
    EXPECT_FALSE(std::filesystem::exists(folder_));
    EXPECT_EQ(refused({}), "");
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "surface.pvd") << "a list";
    EXPECT_EQ(refused({}), "rank 0: " + (folder_ / "surface.pvd").string() +
                               " is there: name a folder without one, or move away what another run has written");
    std::ofstream(directory_ / "file") << "no folder";
    EXPECT_NE(refused({{"output", (directory_ / "file").string()}}).find("cannot be made a directory"),
              std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
