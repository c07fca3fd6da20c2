// The C interface in a build without the service: the functions that need a server say how the library was built.
#include <gtest/gtest.h>

#include <cstdlib>
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

TEST(CWithoutTheService, ConnectingSaysHowTheLibraryWasBuiltWhereNoProgramSpeaksForIt) {
    const char* const variable = std::getenv("PATH");
    ASSERT_NE(variable, nullptr);
    const std::string path = variable;
    ::setenv("PATH", "/nowhere", 1);
    ::unsetenv("MENISCUS_PROGRAM");
    const COptions options = options_of({{"timeout", "1"}});
    int place = 0;
    auto* client = reinterpret_cast<meniscus_client*>(&place);
    EXPECT_TRUE(absent(meniscus_client_connect("127.0.0.1:1", options.get(), &client), "meniscus_client_connect"));
    EXPECT_EQ(client, nullptr);
    EXPECT_TRUE(absent(meniscus_client_connect(nullptr, nullptr, nullptr), "meniscus_client_connect"));
    EXPECT_TRUE(refused(meniscus_client_connect(nullptr, nullptr, nullptr), MENISCUS_UNIMPLEMENTED,
                        "neither named by MENISCUS_PROGRAM nor in PATH"));
    ::setenv("PATH", path.c_str(), 1);
}

TEST(CWithoutTheService, WhatNoProgramDoesForItSaysSo) {
    EXPECT_TRUE(absent(meniscus_client_delete_session(nullptr, ""), "meniscus_client_delete_session"));
    meniscus_watcher* watcher = nullptr;
    EXPECT_TRUE(absent(meniscus_watcher_open(nullptr, "", nullptr, &watcher), "meniscus_watcher_open"));
    meniscus_frame* frame = nullptr;
    EXPECT_TRUE(absent(meniscus_watcher_next(watcher, 0.0, &frame), "meniscus_watcher_next"));
    EXPECT_TRUE(absent(meniscus_watcher_cancel(watcher), "meniscus_watcher_cancel"));
    EXPECT_EQ(meniscus_publisher_session_id(nullptr), nullptr);
    meniscus_publisher_destroy(nullptr);
    meniscus_client_destroy(nullptr);
    meniscus_session_destroy(nullptr);
    meniscus_watcher_destroy(watcher);
    meniscus_frame_destroy(nullptr);
}

TEST(CWithoutTheService, OptionsOfItAreKnown) {
    const COptions options = options_of({{"session", "x"}, {"tls-ca", "ca.pem"}, {"max-level", "2"}});
    EXPECT_TRUE(
        refused(meniscus_options_set(options.get(), "tls-cb", "x"), MENISCUS_INVALID_INPUT, "did you mean tls-ca?"));
}

}  // namespace
}  // namespace meniscus::test
