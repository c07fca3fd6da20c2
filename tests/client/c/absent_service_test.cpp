// The C interface in a build without the service: the functions that need a server say how the library was built.
#include <gtest/gtest.h>

#include <string>

#include "handles.hpp"

namespace meniscus::test {
namespace {

::testing::AssertionResult absent(meniscus_result result, const std::string& function) {
    return refused(result, MENISCUS_UNIMPLEMENTED,
                   function +
                       " is not in this build of Meniscus, which was made without the service: build it without "
                       "-DMENISCUS_SERVICE=OFF");
}

TEST(CWithoutTheService, ConnectingSaysHowTheLibraryWasBuilt) {
    const COptions options = options_of({{"timeout", "1"}});
    int place = 0;
    auto* client = reinterpret_cast<meniscus_client*>(&place);
    EXPECT_TRUE(absent(meniscus_client_connect("127.0.0.1:1", options.get(), &client), "meniscus_client_connect"));
    EXPECT_EQ(client, nullptr);
    EXPECT_TRUE(absent(meniscus_client_connect(nullptr, nullptr, nullptr), "meniscus_client_connect"));
}

TEST(CWithoutTheService, EveryOtherFunctionOfItSaysSoToo) {
    EXPECT_TRUE(absent(meniscus_client_delete_session(nullptr, ""), "meniscus_client_delete_session"));
    meniscus_session* session = nullptr;
    EXPECT_TRUE(absent(meniscus_session_open(nullptr, nullptr, &session), "meniscus_session_open"));
    EXPECT_TRUE(absent(meniscus_session_leave(session), "meniscus_session_leave"));
    EXPECT_TRUE(absent(meniscus_session_push(session, nullptr, 0, 0.0), "meniscus_session_push"));
    EXPECT_TRUE(absent(meniscus_session_try_push(session, nullptr, 0, 0.0), "meniscus_session_try_push"));
    EXPECT_TRUE(absent(meniscus_session_finish(session), "meniscus_session_finish"));
    meniscus_frame* frame = nullptr;
    EXPECT_TRUE(absent(meniscus_session_next(session, 0.0, &frame), "meniscus_session_next"));
    EXPECT_TRUE(absent(meniscus_session_cancel(session), "meniscus_session_cancel"));
    std::uint64_t number = 0;
    EXPECT_TRUE(absent(meniscus_session_dropped(session, &number), "meniscus_session_dropped"));
    EXPECT_EQ(meniscus_session_id(session), nullptr);
    meniscus_watcher* watcher = nullptr;
    EXPECT_TRUE(absent(meniscus_watcher_open(nullptr, "", nullptr, &watcher), "meniscus_watcher_open"));
    EXPECT_TRUE(absent(meniscus_watcher_next(watcher, 0.0, &frame), "meniscus_watcher_next"));
    EXPECT_TRUE(absent(meniscus_watcher_cancel(watcher), "meniscus_watcher_cancel"));
    EXPECT_TRUE(absent(meniscus_frame_index(frame, &number), "meniscus_frame_index"));
    double seconds = 0.0;
    EXPECT_TRUE(absent(meniscus_frame_simulation_time(frame, &seconds), "meniscus_frame_simulation_time"));
    const CMesh mesh = empty_mesh();
    EXPECT_TRUE(absent(meniscus_frame_mesh(frame, mesh.get()), "meniscus_frame_mesh"));
    meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
    EXPECT_TRUE(absent(meniscus_frame_statistics(frame, &statistics), "meniscus_frame_statistics"));
    meniscus_client_destroy(nullptr);
    meniscus_session_destroy(session);
    meniscus_watcher_destroy(watcher);
    meniscus_frame_destroy(frame);
}

TEST(CWithoutTheService, OptionsOfItAreKnown) {
    const COptions options = options_of({{"session", "x"}, {"tls-ca", "ca.pem"}, {"max-level", "2"}});
    EXPECT_TRUE(
        refused(meniscus_options_set(options.get(), "tls-cb", "x"), MENISCUS_INVALID_INPUT, "did you mean tls-ca?"));
}

}  // namespace
}  // namespace meniscus::test
