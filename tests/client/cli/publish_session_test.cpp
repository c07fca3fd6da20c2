// meniscus publish of a session: while it goes on, over runs of its simulator, until it ends.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <future>
#include <string>
#include <vector>

#include "daemon/server.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/mesh_hash.hpp"
#include "process.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

class PublishSession : public testing::Test {
protected:
    PublishSession() {
        Settings settings;
        settings.particle_radius = 0.1;
        client.create_session(id, settings, {.description = {.name = "two", .length_unit = "m"}});
    }

    /// A process that publishes the session, and ends when the session does: a test that fails does not wait for it.
    class Publishing {
    public:
        explicit Publishing(PublishSession& test) : test_(test) {}
        Publishing(const Publishing&) = delete;
        Publishing& operator=(const Publishing&) = delete;
        ~Publishing() {
            if (!result_.valid()) return;
            try {
                test_.client.delete_session(test_.id);
            } catch (const std::exception& error) {
                ADD_FAILURE() << error.what();
            }
        }
        ProcessResult result() { return result_.get(); }

    private:
        PublishSession& test_;
        std::future<ProcessResult> result_ = std::async(std::launch::async, [this] {
            return run_process(MENISCUS_CLI,
                               {"publish", "two", "--server", test_.server.address(), "--to", test_.folder.string()});
        });
    };

    /// The hash of the frame's mesh, once it is published.
    std::string pushed(client::Stream& stream, std::uint64_t index, std::uint64_t published) {
        const std::vector<float> positions{0.0F, 0.0F, 0.0F, 0.1F, 0.01F * static_cast<float>(published), 0.0F};
        ParticleFrame frame;
        frame.positions = positions;
        stream.push(frame, index, 0.5 * static_cast<double>(index));
        std::string hash = mesh_sha256(stream.next()->mesh());
        wait_for(published);
        return hash;
    }
    void wait_for(std::uint64_t frames) const {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (std::chrono::steady_clock::now() < deadline)
            if (client::is_publication(folder) && client::Publication(folder).info().frames >= frames) return;
        FAIL() << "frame " << frames << " was not published";
    }

    static server::ServerOptions options(const TemporaryDirectory& at) {
        server::ServerOptions options;
        options.listen = "unix:" + (at / "socket").string();
        options.backend.threads = 1;
        return options;
    }

    TemporaryDirectory directory;
    const std::filesystem::path folder = directory / "site";
    server::Server server{options(directory)};
    client::Client client{server.address()};
    const std::string id = client::new_session_id();
};

TEST_F(PublishSession, EveryFrameIsThereOnceOverRunsAndPublishersUntilTheSessionEnds) {
    std::vector<std::string> hashes;
    Publishing first(*this);
    wait_for(0);
    {
        auto stream = client.stream(id);
        hashes.push_back(pushed(stream, 3, 1));
        hashes.push_back(pushed(stream, 4, 2));
        stream.finish();
    }
    {
        auto stream = client.stream(id);  // a simulator that has begun again
        hashes.push_back(pushed(stream, 3, 3));
        EXPECT_TRUE(client::Publication(folder).info().live);
        // A second publisher may not write there.
        const ProcessResult second = Publishing(*this).result();
        EXPECT_EQ(second.exit_code, 2);
        EXPECT_NE(second.err.find("another process publishes there"), std::string::npos) << second.err;
        stream.finish();
    }
    client.delete_session(id);
    const ProcessResult result = first.result();
    EXPECT_EQ(result.exit_code, 0) << result.err;

    client::Publication publication(folder);
    const client::PublicationInfo& info = publication.info();
    EXPECT_FALSE(info.live);
    EXPECT_EQ(info.description.name, "two");
    EXPECT_EQ(info.description.length_unit, "m");
    ASSERT_EQ(info.frames, 3U);
    for (std::uint64_t place = 0; place < 3; ++place)
        EXPECT_EQ(mesh_sha256(publication.frame(place).mesh()), hashes[place]) << place;
    EXPECT_EQ(publication.frame(2).index, 3U);
    EXPECT_NE(info.segments.front().run_id, info.segments.back().run_id);
}

TEST_F(PublishSession, SettingsOfASurfaceAndOnePageAreRefused) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{"-r", "1"}, {"-c", "1"}, {"--single-file"}}) {
        std::vector<std::string> arguments{"publish", "two", "--server", server.address(), "--to", folder.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run_process(MENISCUS_CLI, arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder));
    }
}

}  // namespace
}  // namespace meniscus::test
