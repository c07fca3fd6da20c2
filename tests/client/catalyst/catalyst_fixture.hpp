// A simulation of one process with Catalyst, and a meniscusd.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "../c/through_server.hpp"
#include "catalyst_run.hpp"
#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"

namespace meniscus::test {

/// How often a text says something.
inline std::size_t times(const std::string& text, const std::string& words) {
    std::size_t count = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
    return count;
}

class Catalyst : public CThroughServer {
protected:
    ~Catalyst() override { finalize(); }

    std::string options(const std::string& more = "") const {
        return "server=" + address_ + " particle-radius=0.025 policy=every-frame " + more;
    }
    void start(const std::string& more = "") {
        set_options(options(more));
        ASSERT_EQ(initialize(), catalyst_status_ok);
    }
    static int execute_frame(const Particles& particles, std::int64_t step) {
        conduit_node params;
        set_positions(points_mesh(params, step), particles.positions);
        return execute(params);
    }
    CWatcher watch(const char* attributes = nullptr, const char* session_id = nullptr) {
        CWatcher watcher;
        const std::string own = session_id == nullptr ? results().place : session_id;
        const COptions wishes = options_of({{"attribute-bits", "0"}});
        EXPECT_EQ(meniscus_options_set(wishes.get(), "attribute", attributes), MENISCUS_OK);
        EXPECT_EQ(meniscus_watcher_open(client_.get(), own.c_str(), wishes.get(), watcher.out()), MENISCUS_OK)
            << meniscus_error_message();
        return watcher;
    }
    /// The run's session on another server, for one who watches it from now on.
    static CWatcher watch_on(const std::string& address) {
        CClient client;
        EXPECT_EQ(meniscus_client_connect(address.c_str(), nullptr, client.out()), MENISCUS_OK);
        CWatcher watcher;
        EXPECT_EQ(meniscus_watcher_open(client.get(), results().place.c_str(), nullptr, watcher.out()), MENISCUS_OK)
            << meniscus_error_message();
        return watcher;
    }
    static CFrame next(const CWatcher& watcher, std::uint64_t expected_index) {
        CFrame frame;
        EXPECT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
        std::uint64_t index = 0;
        EXPECT_EQ(meniscus_frame_index(frame.get(), &index), MENISCUS_OK);
        EXPECT_EQ(index, expected_index);
        return frame;
    }
    static std::string expected(const Particles& particles) {
        return mesh_sha256(reconstruct(default_settings(), particles.frame()));
    }
    /// Whether an implementation refuses to begin with these words on the standard error output.
    static testing::AssertionResult refuses(const std::string& options, const std::string& words,
                                            int status = status_of(MENISCUS_INVALID_INPUT)) {
        set_options(options);
        testing::internal::CaptureStderr();
        const int got = initialize();
        const std::string said = testing::internal::GetCapturedStderr();
        if (got != status) return testing::AssertionFailure() << "status " << got << ": " << said;
        if (said.find(words) == std::string::npos) return testing::AssertionFailure() << "said: " << said;
        return testing::AssertionSuccess();
    }
    static testing::AssertionResult refuses_frame(conduit_node& params, const std::string& words) {
        testing::internal::CaptureStderr();
        const int got = execute(params);
        const std::string said = testing::internal::GetCapturedStderr();
        if (got != status_of(MENISCUS_INVALID_INPUT)) return testing::AssertionFailure() << "status " << got << said;
        if (said.find(words) == std::string::npos) return testing::AssertionFailure() << "said: " << said;
        return testing::AssertionSuccess();
    }
};

}  // namespace meniscus::test
