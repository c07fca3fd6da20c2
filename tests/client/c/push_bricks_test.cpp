// Publishers of a build without the service, through `meniscus push` and a meniscusd.
#include <gtest/gtest.h>

#include <array>
#include <barrier>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "../../server/process.hpp"
#include "handles.hpp"
#include "thread_ranks.hpp"

namespace meniscus::test {
namespace {

using server::test::on_free_port;
using server::test::Process;

constexpr double patience_with_server = 30.0;  ///< seconds, for what comes at once

/// What a command of the shell writes.
std::string output_of(const std::string& command) {
    std::string out;
    std::FILE* const pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
        out.append(buffer.data(), count);
    EXPECT_EQ(::pclose(pipe), 0) << command;
    return out;
}

/// A surface of a row of particles from `first` on, with ids.
CMesh row(double first, std::size_t count) {
    const COptions options =
        options_of({{"particle-radius", "0.1"}, {"keep-lattice", "true"}, {"threads", "1"}, {"attribute", "id"}});
    CReconstructor reconstructor;
    EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK)
        << meniscus_error_message();
    std::vector<double> positions;
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < count; ++i) {
        positions.insert(positions.end(), {first + 0.2 * static_cast<double>(i), 0.1, -0.1});
        ids.push_back(static_cast<std::uint32_t>(i));
    }
    const meniscus_array id{"id", MENISCUS_UINT32, 1, ids.data()};
    meniscus_particles frame = MENISCUS_PARTICLES_INIT;
    frame.count = count;
    frame.positions_double = positions.data();
    frame.arrays = &id;
    frame.array_count = 1;
    CMesh mesh = empty_mesh();
    EXPECT_EQ(meniscus_reconstruct(reconstructor.get(), &frame, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    return mesh;
}

class CPushBricks : public testing::Test {
protected:
    CPushBricks() : process_(on_free_port()), address_(process_.address()) {
        ::setenv("MENISCUS_PROGRAM", MENISCUS_CLI, 1);
        std::string folder = (std::filesystem::temp_directory_path() / "meniscus-XXXXXX").string();
        folder_ = ::mkdtemp(folder.data());
        EXPECT_EQ(meniscus_client_connect(address_.c_str(), nullptr, client_.out()), MENISCUS_OK)
            << meniscus_error_message();
    }
    ~CPushBricks() override {
        ::unsetenv("MENISCUS_PROGRAM");
        std::filesystem::remove_all(folder_);
    }

    meniscus_result try_open(std::initializer_list<std::pair<const char*, const char*>> more, CPublisher& publisher) {
        const COptions options = options_of({{"particle-radius", "0.1"}, {"attribute", "id"}});
        for (const auto& [name, value] : more) EXPECT_EQ(meniscus_options_set(options.get(), name, value), MENISCUS_OK);
        return meniscus_publisher_open(client_.get(), options.get(), publisher.out());
    }
    CPublisher open(std::initializer_list<std::pair<const char*, const char*>> more = {}) {
        CPublisher publisher;
        EXPECT_EQ(try_open(more, publisher), MENISCUS_OK) << meniscus_error_message();
        return publisher;
    }
    static meniscus_statistics answer_of(const CPublisher& publisher, std::uint64_t index) {
        meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
        CFrame frame;
        EXPECT_EQ(meniscus_publisher_next(publisher.get(), patience_with_server, frame.out()), MENISCUS_OK)
            << meniscus_error_message();
        if (frame.get() == nullptr) return statistics;
        std::uint64_t is = 0;
        EXPECT_EQ(meniscus_frame_index(frame.get(), &is), MENISCUS_OK);
        EXPECT_EQ(is, index);
        EXPECT_EQ(meniscus_frame_statistics(frame.get(), &statistics), MENISCUS_OK);
        return statistics;
    }
    /// Of the session's newest mesh, as a watcher receives it.
    std::string shown_sha256(const CPublisher& publisher) const {
        return shown_sha256(std::string(meniscus_publisher_session_id(publisher.get())));
    }
    std::string shown_sha256(const std::string& id) const {
        const std::string cli = MENISCUS_CLI;
        output_of(cli + " watch " + id + " --server " + address_ + " -o " + folder_ + " --format bricks --frames 1 -q");
        const std::string file = std::filesystem::directory_iterator(folder_)->path().string();
        std::string said = output_of(cli + " compare " + file + " " + file + " --particle-radius 0.1");
        std::filesystem::remove(file);
        const std::size_t at = said.find("mesh_sha256 ");
        return at == std::string::npos ? said : said.substr(at + 12, 64);
    }

    Process process_;
    std::string address_;
    std::string folder_;
    CClient client_;
};

TEST_F(CPushBricks, GiveWatchersTheMeshThatTheyPush) {
    for (const char* const codec : {"packed", "entropy"}) {
        const CPublisher publisher = open({{"codec", codec}, {"attribute-bits", "12"}, {"name", "a row"}});
        for (std::uint64_t i = 0; i < 3; ++i) {
            const CMesh mesh = row(-1.0 + static_cast<double>(i), 40 + i);
            ASSERT_EQ(meniscus_publisher_push(publisher.get(), mesh.get(), 10 + i, 0.5), MENISCUS_OK)
                << meniscus_error_message();
            const meniscus_statistics statistics = answer_of(publisher, 10 + i);
            EXPECT_EQ(statistics.particles, 40 + i);
            EXPECT_GT(statistics.volume, 0.0);
            EXPECT_GT(statistics.stage_seconds[3], 0.0);
            EXPECT_EQ(shown_sha256(publisher), sha256(mesh));
        }
        EXPECT_EQ(meniscus_publisher_finish(publisher.get()), MENISCUS_OK);
        CFrame frame;
        EXPECT_EQ(meniscus_publisher_next(publisher.get(), patience_with_server, frame.out()), MENISCUS_ENDED)
            << meniscus_error_message();
        std::uint64_t dropped = 1;
        EXPECT_EQ(meniscus_publisher_dropped(publisher.get(), &dropped), MENISCUS_OK);
        EXPECT_EQ(dropped, 0U);
    }
}

TEST_F(CPushBricks, OfSeveralProcessesMakeOneSurface) {
    const CMesh whole = row(-3.0, 60);
    const CPublisher first = open({{"parts", "2"}, {"part", "0"}, {"run", "7"}});
    const CPublisher second =
        open({{"session", meniscus_publisher_session_id(first.get())}, {"parts", "2"}, {"part", "1"}, {"run", "7"}});
    constexpr std::int32_t below = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t above = std::numeric_limits<std::int32_t>::max();
    const std::int32_t lowest[2][3] = {{below, below, below}, {1, below, below}};
    const std::int32_t highest[2][3] = {{0, above, above}, {above, above, above}};
    for (const auto& [publisher, box] : {std::pair{&first, 0}, {&second, 1}})
        ASSERT_EQ(meniscus_publisher_push_box(publisher->get(), whole.get(), lowest[box], highest[box], 4, 1.0),
                  MENISCUS_OK)
            << meniscus_error_message();
    const meniscus_statistics of_first = answer_of(first, 4);
    EXPECT_EQ(answer_of(second, 4).triangles, of_first.triangles);
    EXPECT_EQ(shown_sha256(first), sha256(whole));
}

TEST_F(CPushBricks, OfRanksThatReconstructTogetherMakeTheSurfaceOfOneProcess) {
    constexpr std::size_t count = 60;
    const std::string expected = sha256(row(-3.0, count));
    std::barrier<> seen(3);
    on_ranks(3, [&](const meniscus_exchange& exchange) {
        const COptions options = options_of({{"server", address_.c_str()},
                                             {"particle-radius", "0.1"},
                                             {"threads", "1"},
                                             {"policy", "every-frame"},
                                             {"reconstruct-ranks", "2"}});
        meniscus_parts* parts = nullptr;
        ASSERT_EQ(meniscus_parts_open(&exchange, options.get(), &parts), MENISCUS_OK) << meniscus_error_message();
        std::vector<double> positions;
        for (std::size_t i = exchange.rank; i < count; i += 3)
            positions.insert(positions.end(), {-3.0 + 0.2 * static_cast<double>(i), 0.1, -0.1});
        meniscus_particles mine = MENISCUS_PARTICLES_INIT;
        mine.count = positions.size() / 3;
        mine.positions_double = positions.data();
        // The first frame is shown with the second one.
        for (std::uint64_t step = 0; step < 2; ++step)
            EXPECT_EQ(meniscus_parts_push(parts, &mine, step, 0.0), MENISCUS_OK) << meniscus_error_message();
        if (exchange.rank == 2) {
            EXPECT_EQ(shown_sha256(std::string(meniscus_parts_session_id(parts))), expected);
        }
        seen.arrive_and_wait();
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
}

TEST_F(CPushBricks, RefuseWhatIsWrongBeforeItIsSentAndGoOn) {
    CPublisher publisher;
    EXPECT_TRUE(refused(try_open({{"codec", "zip"}}, publisher), MENISCUS_INVALID_INPUT, "option 'codec' is 'zip'"));
    EXPECT_TRUE(refused(try_open({{"meshes", "true"}}, publisher), MENISCUS_INVALID_INPUT,
                        "option 'meshes' is not known here"));
    EXPECT_TRUE(refused(try_open({{"ephemeral", "false"}}, publisher), MENISCUS_UNIMPLEMENTED, "option 'ephemeral'"));
    EXPECT_TRUE(refused(try_open({{"route-check", "1"}}, publisher), MENISCUS_UNIMPLEMENTED, "option 'route-check'"));
    EXPECT_EQ(publisher.get(), nullptr);
    publisher = open();
    const CMesh mesh = row(0.0, 5);
    EXPECT_TRUE(refused(
        meniscus_publisher_push(publisher.get(), empty_mesh().get(), 0, std::numeric_limits<double>::infinity()),
        MENISCUS_INVALID_INPUT, "simulation_time is inf"));
    EXPECT_EQ(meniscus_publisher_push(publisher.get(), mesh.get(), 4, 0.0), MENISCUS_OK) << meniscus_error_message();
    EXPECT_TRUE(refused(meniscus_publisher_push(publisher.get(), mesh.get(), 4, 0.0), MENISCUS_INVALID_INPUT,
                        "frame index 4 after 4"));
    const COptions options = options_of({{"particle-radius", "0.1"}});
    CReconstructor reconstructor;
    ASSERT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK);
    const float place[3] = {0.0F, 0.0F, 0.0F};
    meniscus_particles frame = MENISCUS_PARTICLES_INIT;
    frame.count = 1;
    frame.positions = place;
    const CMesh without = empty_mesh();
    ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &frame, without.get()), MENISCUS_OK);
    EXPECT_TRUE(refused(meniscus_publisher_push(publisher.get(), without.get(), 5, 0.0), MENISCUS_INVALID_INPUT,
                        "frame 5: the mesh has no lattice"));
    EXPECT_EQ(meniscus_publisher_push(publisher.get(), mesh.get(), 5, 0.0), MENISCUS_OK);
    EXPECT_TRUE(refused(meniscus_publisher_leave(publisher.get()), MENISCUS_UNIMPLEMENTED, "ends with its publisher"));
    EXPECT_TRUE(refused(meniscus_publisher_push(nullptr, mesh.get(), 6, 0.0), MENISCUS_INVALID_INPUT, "is NULL"));
    EXPECT_TRUE(refused(meniscus_publisher_push(publisher.get(), nullptr, 6, 0.0), MENISCUS_INVALID_INPUT, "is NULL"));
}

TEST_F(CPushBricks, TellTheServersRefusalWithItsCodeAgainAndAgain) {
    const CPublisher publisher = open({{"cell-size", "1"}});
    const CMesh mesh = row(0.0, 50);
    meniscus_result result = MENISCUS_OK;
    for (std::uint64_t i = 0; result == MENISCUS_OK; ++i)
        result = meniscus_publisher_push(publisher.get(), mesh.get(), i, 0.0);
    EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "with the session's settings"));
    CFrame frame;
    for (int i = 0; i < 2; ++i)
        EXPECT_TRUE(refused(meniscus_publisher_next(publisher.get(), patience_with_server, frame.out()),
                            MENISCUS_INVALID_INPUT, "with the session's settings"));
}

TEST_F(CPushBricks, AreCanceledFromAnotherThread) {
    const CPublisher publisher = open();
    std::thread canceling([&] { EXPECT_EQ(meniscus_publisher_cancel(publisher.get()), MENISCUS_OK); });
    CFrame frame;
    EXPECT_EQ(meniscus_publisher_next(publisher.get(), -1.0, frame.out()), MENISCUS_ENDED);
    canceling.join();
    const CMesh mesh = row(0.0, 50);
    meniscus_result result = MENISCUS_OK;
    for (std::uint64_t i = 0; result == MENISCUS_OK; ++i)
        result = meniscus_publisher_push(publisher.get(), mesh.get(), i, 0.0);
    EXPECT_EQ(result, MENISCUS_CANCELED) << meniscus_error_message();
}

TEST_F(CPushBricks, SayThatThereIsNoServer) {
    CClient client;
    ASSERT_EQ(meniscus_client_connect("unix:/nowhere/meniscus", nullptr, client.out()), MENISCUS_OK);
    const COptions options = options_of({{"particle-radius", "0.1"}});
    CPublisher publisher;
    EXPECT_TRUE(refused(meniscus_publisher_open(client.get(), options.get(), publisher.out()), MENISCUS_UNAVAILABLE,
                        "no server at unix:/nowhere/meniscus"));
}

}  // namespace
}  // namespace meniscus::test
