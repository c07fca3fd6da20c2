// A meniscusd in a process of its own, for tests of the C interface.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "../../server/process.hpp"
#include "handles.hpp"

namespace meniscus::test {

inline constexpr double patience = 30.0;  ///< seconds, for what comes at once

inline std::string sha256_of(const CFrame& frame) {
    const CMesh mesh = empty_mesh();
    EXPECT_EQ(meniscus_frame_mesh(frame.get(), mesh.get()), MENISCUS_OK) << meniscus_error_message();
    return sha256(mesh);
}

class CThroughServer : public testing::Test {
protected:
    CThroughServer() : process_(server::test::on_free_port()), address_(process_.address()) {
        EXPECT_EQ(meniscus_client_connect(address_.c_str(), nullptr, client_.out()), MENISCUS_OK)
            << meniscus_error_message();
    }

    CWatcher watch(const char* session_id) {
        CWatcher watcher;
        EXPECT_EQ(meniscus_watcher_open(client_.get(), session_id, nullptr, watcher.out()), MENISCUS_OK)
            << meniscus_error_message();
        return watcher;
    }
    /// Whether the server has a session of this id, by watching it.
    bool is_there(const std::string& id) {
        CWatcher watcher;
        CFrame frame;
        meniscus_result result = meniscus_watcher_open(client_.get(), id.c_str(), nullptr, watcher.out());
        if (result == MENISCUS_OK) result = meniscus_watcher_next(watcher.get(), 0.1, frame.out());
        return result != MENISCUS_NOT_FOUND;
    }

    server::test::Process process_;
    std::string address_;
    CClient client_;
};

}  // namespace meniscus::test
