// A simulator that goes on with another server, and how clients know servers apart.
#include <gtest/gtest.h>

#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

std::string instance_in(const std::multimap<grpc::string_ref, grpc::string_ref>& metadata) {
    const auto found = metadata.find("x-server-instance");
    return found == metadata.end() ? "" : std::string(found->second.begin(), found->second.end());
}

/// The server's instance, from the end of a call about a session that the server does not have.
std::string instance_of(const RunningServer& running) {
    const client::Connection connection(running.server.address());
    grpc::ClientContext context;
    v1::GetSessionRequest request;
    request.set_id(client::new_session_id());
    client::add_session_id(context, request.id());
    v1::GetSessionResponse response;
    EXPECT_EQ(connection.sessions->GetSession(&context, request, &response).error_code(), grpc::StatusCode::NOT_FOUND);
    return instance_in(context.GetServerTrailingMetadata());
}

void send_frame(RawStream& stream, std::uint64_t index) {
    stream.send_begin(index, 1);
    stream.send_chunk(12);
    stream.send_end();
}

void send_move(RawStream& stream) {
    v1::StreamRequest request;
    request.mutable_move();
    stream.call->Write(request);
}

TEST(ServerInstance, IsAnothersForEveryServerAndTheSameForEveryCall) {
    RunningServer one;
    RunningServer another;
    EXPECT_EQ(instance_of(one).size(), 16U);
    EXPECT_EQ(instance_of(one), instance_of(one));
    EXPECT_NE(instance_of(one), instance_of(another));
}

TEST(ServerInstance, IsToldByAStreamBeforeItsFirstAnswerAndAtItsEnd) {
    RunningServer running;
    RawStream stream(running.server.address(), running.session());
    stream.call->WaitForInitialMetadata();
    EXPECT_EQ(instance_in(stream.context.GetServerInitialMetadata()), instance_of(running));
    stream.call->WritesDone();
    EXPECT_TRUE(stream.finish().ok());
    EXPECT_EQ(instance_in(stream.context.GetServerTrailingMetadata()), instance_of(running));
}

TEST(StreamMove, EndsTheSessionAndItsWatchersOnceAllIsAnswered) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    RawStream stream(running.server.address(), id);
    for (std::uint64_t i = 0; i < 5; ++i) send_frame(stream, i);
    send_move(stream);
    const grpc::Status status = stream.finish();
    EXPECT_EQ(stream.answered, 5);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
    EXPECT_NE(status.error_message().find("has moved to another server"), std::string::npos) << status.error_message();
    std::optional<std::uint64_t> last;
    try {
        while (const auto frame = watcher.next()) last = frame->index;
        FAIL() << "ended well";
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.status(), "UNAVAILABLE");
    }
    EXPECT_EQ(last, 4U);
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(StreamMove, IsRefusedWithinAFrame) {
    RunningServer running;
    const std::string id = running.session();
    RawStream stream(running.server.address(), id);
    stream.send_begin(0, 1);
    send_move(stream);
    EXPECT_EQ(stream.finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(running.client.session(id).frames, 0U);
}

TEST(StreamMove, LeavesTheIdFreeForANewSession) {
    RunningServer running;
    const std::string id = running.session();
    RawStream stream(running.server.address(), id);
    send_frame(stream, 7);
    send_move(stream);
    stream.finish();
    running.client.create_session(id, settings());
    RawStream next(running.server.address(), id);
    send_frame(next, 0);
    next.call->WritesDone();
    EXPECT_TRUE(next.finish().ok());
    EXPECT_EQ(next.answered, 1);
}

}  // namespace
}  // namespace meniscus::server::test
