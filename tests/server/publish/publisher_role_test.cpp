// The role whose token publishes surfaces that were made elsewhere.
#include <gtest/gtest.h>

#include <string>

#include "dealt_bricks.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {
namespace {

const std::string ada = "token-of-ada-0123456789";
const std::string pia = "token-of-pia-0123456789";
const std::string eve = "token-of-eve-0123456789";
const std::string root = "token-of-root-0123456789";

struct PublisherRole : testing::Test {
    static ServerOptions options(const std::string& file) {
        ServerOptions options = test_options();
        options.tokens = file;
        return options;
    }
    client::Client client(const std::string& token) const { return client::Client(server.address(), {.token = token}); }
    /// What publishing a surface to a session, which the caller has made if it could, ends with.
    std::string publish(const std::string& token, const std::string& session) const {
        LocalSurface local(settings());
        local.reconstruct(wave(4, 0.0).view());
        client::Client caller = client(token);
        try {
            auto publisher = caller.publish(session);
            publisher.push(local.encoded(0));
            publisher.finish();
            return publisher.next() ? "an answer" : "nothing";
        } catch (const client::ServerError& error) {
            return error.what();
        }
    }
    std::string session_of(const std::string& token) const {
        std::string id = client::new_session_id();
        client(token).create_session(id, settings());
        return id;
    }

    const TestFolder folder;
    Server server{options(folder.write("tokens",
                                       "uploader ada token-of-ada-0123456789\n"
                                       "publisher pia token-of-pia-0123456789\n"
                                       "watcher eve token-of-eve-0123456789\n"
                                       "admin root token-of-root-0123456789\n"))};
};

TEST_F(PublisherRole, MayPublishToSessionsOfItsOwn) {
    EXPECT_EQ(publish(pia, session_of(pia)), "an answer");
    const std::string others = session_of(ada);
    EXPECT_NE(publish(pia, others).find("no session " + others), std::string::npos);
    EXPECT_EQ(client(pia).sessions().size(), 1U);
}

TEST_F(PublisherRole, MayStreamAsUploadersMay) {
    client::Client caller = client(pia);
    auto stream = caller.stream(session_of(pia));
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    EXPECT_TRUE(stream.next());
}

TEST_F(PublisherRole, IsNotThatOfUploadersAndWatchers) {
    EXPECT_NE(publish(ada, session_of(ada))
                  .find("Publish needs a token of the role publisher or admin; that of ada has the role uploader"),
              std::string::npos);
    EXPECT_NE(publish(eve, session_of(root))
                  .find("Publish needs a token of the role publisher or admin; that of eve has the role watcher"),
              std::string::npos);
    EXPECT_EQ(publish(root, session_of(root)), "an answer");
}

}  // namespace
}  // namespace meniscus::server::test
