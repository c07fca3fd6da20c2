// The ranks of an MPI job make one surface, whoever owns the particles: that of one process.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../c/through_server.hpp"
#include "meniscus/meniscus.hpp"
#include "mpi_process.hpp"
#include "support/particles.hpp"

namespace meniscus::test {
namespace {

/// parts_job under mpirun, step by step.
class Job {
public:
    Job(int ranks, std::vector<std::string> arguments) : process_(ranks, with_program(std::move(arguments))) {}

    void go_on() { process_.write("\n"); }
    /// Its next line, but for those of process ids.
    std::string line() {
        std::array<char, 1024> text{};
        do {
            if (std::fgets(text.data(), text.size(), process_.output()) == nullptr) return "nothing";
        } while (std::string_view(text.data()).starts_with("pid "));
        std::string line = text.data();
        line.erase(line.find_last_not_of(" \n") + 1);
        return line;
    }

private:
    static std::vector<std::string> with_program(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), MENISCUS_JOB);
        return arguments;
    }

    MpiProcess process_;
};

class MpiParts : public CThroughServer {
protected:
    static constexpr unsigned frames = 4;

    MpiParts() {
        std::string folder = (std::filesystem::temp_directory_path() / "meniscus-XXXXXX").string();
        folder_ = ::mkdtemp(folder.data());
        Settings settings = default_settings();
        settings.cell_size = 0.25;
        for (unsigned i = 0; i < frames; ++i) {
            const Particles particles = splash(i, 8);
            files_.push_back(folder_ + "/" + std::to_string(i));
            std::ofstream(files_.back(), std::ios::binary)
                .write(reinterpret_cast<const char*>(particles.positions.data()),
                       static_cast<std::streamsize>(particles.positions.size() * sizeof(float)));
            hashes_.push_back(mesh_sha256(reconstruct(settings, particles.frame())));
        }
    }
    ~MpiParts() override { std::filesystem::remove_all(folder_); }

    std::vector<std::string> arguments(const std::string& deal, const std::string& makers) const {
        std::vector<std::string> words{
            deal,        "server=" + address_, "particle-radius=0.025",      "cell-size=0.25",
            "threads=1", "policy=every-frame", "reconstruct-ranks=" + makers};
        words.insert(words.end(), files_.begin(), files_.end());
        return words;
    }

    std::string folder_;
    std::vector<std::string> files_;
    std::vector<std::string> hashes_;
};

TEST_F(MpiParts, GiveWatchersTheSurfaceOfOneProcess) {
    struct Run {
        int ranks;
        const char* deal;
        const char* makers;
    };
    for (const Run& run : {Run{1, "one", "node"}, Run{2, "random", "all"}, Run{3, "moving", "2"},
                           Run{4, "slabs", "all"}, Run{3, "one", "node"}}) {
        SCOPED_TRACE(testing::Message() << run.ranks << " ranks, " << run.deal << ", " << run.makers);
        Job job(run.ranks, arguments(run.deal, run.makers));
        const std::string session = job.line();
        ASSERT_EQ(session.substr(0, 8), "session ");
        ASSERT_EQ(job.line(), "ok");
        const CWatcher watcher = watch(session.substr(8).c_str());
        for (unsigned i = 0; i < frames; ++i) {
            job.go_on();
            ASSERT_EQ(job.line(), "ok");
            if (i == 0) continue;
            CFrame seen;
            ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, seen.out()), MENISCUS_OK)
                << meniscus_error_message();
            EXPECT_EQ(sha256_of(seen), hashes_[i - 1]);
        }
        job.go_on();
        EXPECT_EQ(job.line(), "ok");
    }
}

/// The value of an attribute of the first element that has it.
std::size_t number_in(const std::string& file, const std::string& attribute) {
    std::ifstream stream(file);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t at = text.find(attribute + "=\"");
    return at == std::string::npos ? 0 : std::stoul(text.substr(at + attribute.size() + 2, 20));
}

TEST_F(MpiParts, WriteTheTrianglesOfOneProcessToFiles) {
    std::vector<std::string> words = arguments("random", "all");
    words[1] = "output=" + folder_ + "/surfaces";
    {
        Job job(3, words);
        ASSERT_EQ(job.line(), "session");
        ASSERT_EQ(job.line(), "ok");
        for (unsigned i = 0; i <= frames; ++i) {  // and the end
            job.go_on();
            ASSERT_EQ(job.line(), "ok");
        }
    }
    Settings settings = default_settings();
    settings.cell_size = 0.25;
    for (unsigned i = 0; i < frames; ++i) {
        std::size_t triangles = 0;
        for (const char* const part : {"0", "1", "2"})
            triangles += number_in(folder_ + "/surfaces/surface-00000" + std::to_string(i) + "-part-" + part + ".vtp",
                                   "NumberOfPolys");
        EXPECT_EQ(triangles, reconstruct(settings, splash(i, 8).frame()).triangles.size());
    }
    std::ifstream list(folder_ + "/surfaces/surface.pvd");
    std::size_t listed = 0;
    for (std::string line; std::getline(list, line);) listed += line.find("<DataSet") != std::string::npos ? 1 : 0;
    EXPECT_EQ(listed, 3 * frames);
}

TEST_F(MpiParts, SayTogetherThatThereIsNoServer) {
    std::vector<std::string> words = arguments("random", "all");
    words[1] = "server=unix:/nowhere/meniscus";
    Job job(3, words);
    EXPECT_EQ(job.line().substr(0, 55), "unavailable rank 0: no server at unix:/nowhere/meniscus");
}

}  // namespace
}  // namespace meniscus::test
