#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include "held_opening.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

TEST(Shutdown, EndsAStreamThatIsBeingOpened) {
    const auto opening = std::make_shared<HeldOpening>();
    const auto logger_before = spdlog::default_logger();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", opening));
    {
        RunningServer running;
        RawStream stream(running.server.address(), running.session());
        opening->held.get_future().wait();
        std::thread stopping([&] { running.server.shutdown(); });
        EXPECT_EQ(stream.finish().error_code(), grpc::StatusCode::UNAVAILABLE);
        opening->released.set_value();
        stopping.join();
    }
    spdlog::set_default_logger(logger_before);
}

TEST(Shutdown, DoesNotWaitForAStreamThatNeverOpens) {
    RunningServer running;
    const std::string id = running.session();
    RawStream stream(running.server.address(), id, false);
    // On the same connection, so that the stream is there before it.
    grpc::ClientContext context;
    client::add_session_id(context, id);
    v1::GetSessionRequest request;
    request.set_id(id);
    v1::GetSessionResponse response;
    ASSERT_TRUE(stream.connection.sessions->GetSession(&context, request, &response).ok());
    const auto begin = std::chrono::steady_clock::now();
    running.server.shutdown();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10)) << "the grace is a minute";
    EXPECT_FALSE(stream.finish().ok());
}

TEST(Shutdown, LetsAFrameThatIsOnItsWayInBeTheLast) {
    RunningServer running;
    RawStream stream(running.server.address(), running.session());
    // More than gRPC's buffers hold, so that the server has begun to read the frame. Its answer is a refusal, which
    // takes no time, but only a frame that is complete gets it.
    constexpr std::size_t chunks = 24;
    constexpr std::size_t particles_per_chunk = chunk_bytes / 12;
    v1::StreamRequest not_finite;
    not_finite.mutable_frame_chunk()->set_data(std::string(particles_per_chunk * 12, '\xff'));
    stream.send_begin(0, chunks * particles_per_chunk);
    for (std::size_t i = 0; i + 1 < chunks; ++i) stream.call->Write(not_finite);
    std::thread stopping([&] { running.server.shutdown(); });
    stream.call->Write(not_finite);
    stream.send_end();
    const grpc::Status status = stream.finish();
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    stopping.join();
}

TEST(Shutdown, TellsWatchersWhyAfterTheLastMesh) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    {
        auto stream = running.client.stream(id);
        stream.push(wave(6, 0.0).view(), 7, 0.0);
        ASSERT_TRUE(stream.next());
    }
    std::thread stopping([&] { running.server.shutdown(); });
    EXPECT_EQ(watcher.next()->index, 7U);
    EXPECT_THROW(watcher.next(), client::ServerError);
    stopping.join();
}

TEST(Shutdown, IsAnnouncedToWatchers) {
    RunningServer running;
    const std::string id = running.session();
    client::Connection connection(running.server.address());
    grpc::ClientContext context;
    client::add_session_id(context, id);
    v1::WatchRequest request;
    request.set_session_id(id);
    const auto call = connection.surfaces->Watch(&context, request);
    call->WaitForInitialMetadata();
    std::thread stopping([&] { running.server.shutdown(); });
    v1::WatchResponse response;
    ASSERT_TRUE(call->Read(&response));
    EXPECT_EQ(response.draining().seconds(), 59.5);  // the rest is kept for canceling calls
    EXPECT_FALSE(call->Read(&response));
    EXPECT_EQ(call->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
    stopping.join();
}

TEST(Shutdown, TellsAnIdleStreamWhy) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    running.server.shutdown();
    try {
        stream.next();
        FAIL();
    } catch (const client::ServerError& error) {
        EXPECT_NE(std::string(error.what()).find("shutting down"), std::string::npos) << error.what();
    }
}

TEST(Shutdown, DoesNotWaitForClientsThatNeverReadBeyondTheGracePeriod) {
    ServerOptions options = test_options();
    options.shutdown_grace = std::chrono::milliseconds(300);
    RunningServer running(options);
    const std::string id = running.session();
    RawStream stream(running.server.address(), id, false);
    v1::StreamRequest open;
    open.mutable_open()->set_session_id(id);
    open.mutable_open()->set_receive_meshes(true);
    stream.call->Write(open);
    auto watcher = running.client.watch(id);
    const Particles particles = spray(12);
    v1::StreamRequest data;
    data.mutable_frame_chunk()->set_data(particles.positions.data(), particles.positions.size() * sizeof(float));
    std::thread pusher([&] {
        for (std::uint64_t i = 0; i < 60; ++i) {  // until the server takes no more, then until it is gone
            stream.send_begin(i, particles.positions.size() / 3);
            stream.call->Write(data);
            stream.send_end();
        }
    });
    while (running.client.session(id).frames < 2) {
    }
    running.server.shutdown();
    pusher.join();
    EXPECT_FALSE(stream.finish().ok());
}

TEST(Shutdown, DoesNotWaitForAFrameThatNeverEndsBeyondTheGracePeriod) {
    ServerOptions options = test_options();
    options.shutdown_grace = std::chrono::milliseconds(300);
    RunningServer running(options);
    RawStream stream(running.server.address(), running.session());
    stream.send_begin(0, 1);
    running.server.shutdown();
    EXPECT_FALSE(stream.finish().ok());
}

// Asserts by not hanging: every call returns, and so does the server's destructor.
TEST(Shutdown, IsDoneOnceHoweverOftenItIsAskedFor) {
    RunningServer running;
    running.server.shutdown();
    running.server.shutdown();
}

}  // namespace
}  // namespace meniscus::server::test
