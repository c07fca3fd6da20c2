// Streams that wait for a session to which another one uploads.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "held_opening.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

void ask_about(const std::string& id, const client::Connection& connection) {
    grpc::ClientContext context;
    client::add_session_id(context, id);
    v1::GetSessionRequest request;
    request.set_id(id);
    v1::GetSessionResponse response;
    ASSERT_TRUE(connection.sessions->GetSession(&context, request, &response).ok());
}

/// The waiting stream is canceled while its session has become free and it is being opened.
void cancel_an_opening(RunningServer& running, const std::string& id) {
    using namespace std::chrono_literals;
    const auto opening = std::make_shared<HeldOpening>();
    RawStream first(running.server.address(), id);
    first.call->WaitForInitialMetadata();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", opening));
    RawStream waiting(running.server.address(), id);
    // On the same connection, so that the server has the stream by then.
    for (int i = 0; i < 3; ++i) ask_about(id, waiting.connection);
    first.context.TryCancel();
    opening->held.get_future().wait();
    waiting.context.TryCancel();
    // Time in which the call would end, if it could. The held thread is one of gRPC's: for other calls it adds threads.
    std::vector<std::future<void>> others;
    others.reserve(16);
    for (int i = 0; i < 16; ++i)
        others.push_back(std::async(std::launch::async, [&] { ask_about(id, waiting.connection); }));
    std::this_thread::sleep_for(200ms);
    opening->released.set_value();
    others.clear();
    EXPECT_EQ(waiting.finish().error_code(), grpc::StatusCode::CANCELLED);
    EXPECT_EQ(first.finish().error_code(), grpc::StatusCode::CANCELLED);
}

TEST(WaitingStream, ThatIsCanceledWhileItOpensLeavesTheSessionFree) {
    const auto logger_before = spdlog::default_logger();
    {
        RunningServer running;
        // The order of threads is gRPC's.
        for (int round = 0; round < 4; ++round) {
            const std::string id = running.session();
            cancel_an_opening(running, id);
            spdlog::set_default_logger(logger_before);
            const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
            while (running.client.session(id).uploading && std::chrono::steady_clock::now() < until)
                std::this_thread::yield();
            ASSERT_FALSE(running.client.session(id).uploading);
        }
    }
}

}  // namespace
}  // namespace meniscus::server::test
