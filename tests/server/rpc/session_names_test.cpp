// Names of sessions over the wire, and sessions that go with their stream.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <thread>

#include "conversion/settings_conversion.hpp"
#include "meniscus/client/session_lookup.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"
#include "tcp_proxy.hpp"

namespace meniscus::server::test {
namespace {

const client::SessionDescription wave_pool{.name = "W\u00e4ve pool", .up_axis = client::UpAxis::y, .length_unit = "m"};

void expect_wave_pool(const client::SessionDescription& description) {
    EXPECT_EQ(description.name, wave_pool.name);
    EXPECT_EQ(description.up_axis, wave_pool.up_axis);
    EXPECT_EQ(description.length_unit, wave_pool.length_unit);
}

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

TEST(SessionDescription, IsKeptAndIsNotAmongWhatAJoinerMustMatch) {
    RunningServer running;
    const std::string id = client::new_session_id();
    const auto before = std::chrono::floor<std::chrono::microseconds>(std::chrono::system_clock::now());
    EXPECT_TRUE(running.client.create_session(id, settings(), {.description = wave_pool, .ephemeral = true}));
    EXPECT_FALSE(running.client.create_session(id, settings(), {.description = {.name = "other"}}));
    const client::SessionInfo info = running.client.session(id);
    expect_wave_pool(info.description);
    EXPECT_TRUE(info.ephemeral);
    EXPECT_GE(info.created_at, before);
    EXPECT_LE(info.created_at, std::chrono::system_clock::now());
    expect_wave_pool(running.client.sessions().front().description);
    EXPECT_TRUE(running.client.session(running.session()).description.name.empty());
}

TEST(SessionDescription, HasNothingThatNobodySees) {
    RunningServer running;
    v1::CreateSessionRequest request;
    request.set_id(client::new_session_id());
    *request.mutable_settings() = conversion::to_wire(settings());
    request.mutable_description()->set_name("wave pool");
    auto& unknown =
        *request.mutable_description()->GetReflection()->MutableUnknownFields(request.mutable_description());
    unknown.AddLengthDelimited(99, std::string(60'000, 'a'));
    const client::Connection connection(running.server.address());
    grpc::ClientContext context;
    client::add_session_id(context, request.id());
    v1::CreateSessionResponse response;
    ASSERT_TRUE(connection.sessions->CreateSession(&context, request, &response).ok());
    EXPECT_EQ(response.session().description().name(), "wave pool");
    EXPECT_LT(response.session().description().ByteSizeLong(), 100U);
}

TEST(SessionDescription, IsRefusedByTheClientBeforeItIsSent) {
    RunningServer running;
    for (const std::string name : {"a\nb", "\xff", "\u202egnp"})
        EXPECT_THROW(
            running.client.create_session(client::new_session_id(), settings(), {.description = {.name = name}}),
            InvalidInput);
    EXPECT_THROW(running.client.create_session(client::new_session_id(), settings(),
                                               {.description = {.length_unit = std::string(17, 'm')}}),
                 InvalidInput);
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(SessionName, StandsForTheOnlySessionThatHasIt) {
    RunningServer running;
    const std::string id = client::new_session_id();
    const std::string other = client::new_session_id();
    running.client.create_session(id, settings(), {.description = wave_pool});
    EXPECT_EQ(client::session_id_of(running.client, wave_pool.name), id);
    EXPECT_EQ(client::session_id_of(running.client, other), other) << "an id is one, whether it is there or not";
    EXPECT_NE(message_of([&] { client::session_id_of(running.client, "w\u00e4ve pool"); }).find("no session has"),
              std::string::npos);
    EXPECT_THROW(client::session_id_of(running.client, ""), InvalidInput);
    running.client.create_session(other, settings(), {.description = wave_pool});
    const std::string message = message_of([&] { client::session_id_of(running.client, wave_pool.name); });
    for (const std::string& word : {id, other, std::string("2 sessions")})
        EXPECT_NE(message.find(word), std::string::npos) << message;
    // A name in the form of an id is never taken for it.
    running.client.create_session(client::new_session_id(), settings(), {.description = {.name = id}});
    EXPECT_EQ(client::session_id_of(running.client, id), id);
}

ServerOptions ephemeral_after(std::chrono::milliseconds time) {
    ServerOptions options = test_options();
    options.listen = "127.0.0.1:0";
    options.limits.ephemeral_time = time;
    options.limits.orphan_time = std::chrono::minutes(2);
    return options;
}

void wait_until_gone(RunningServer& running) {
    while (!running.client.sessions().empty()) std::this_thread::yield();
}

TEST(SessionsToStreamTo, EndIfNoStreamFollowsAndOthersStay) {
    ServerOptions options = test_options();
    options.limits.orphan_time = std::chrono::milliseconds(200);
    RunningServer running(options);
    const std::string stays = client::new_session_id();
    const std::string followed = client::new_session_id();
    running.client.create_session(stays, settings());
    running.client.create_session(followed, settings(), {.stream_follows = true});
    auto stream = running.client.stream(followed);
    running.client.create_session(client::new_session_id(), settings(), {.stream_follows = true});
    stream.finish();
    EXPECT_FALSE(stream.next());
    while (running.client.sessions().size() > 2) std::this_thread::yield();
    EXPECT_EQ(running.client.session(stays).frames, 0U);
    EXPECT_EQ(running.client.session(followed).frames, 0U);
}

TEST(EphemeralSessions, EndWithTheirStreamAndTheirWatchersEndWell) {
    RunningServer running(ephemeral_after(std::chrono::seconds(1)));
    const std::string id = client::new_session_id();
    running.client.create_session(id, settings(), {.ephemeral = true});
    auto stream = running.client.stream(id);
    auto watcher = running.client.watch(id);
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    stream.finish();
    ASSERT_TRUE(stream.next());
    EXPECT_FALSE(stream.next());
    ASSERT_TRUE(watcher.next());
    EXPECT_FALSE(watcher.next());
    EXPECT_EQ(watcher.end_reason(), "it is ephemeral, and no stream has come for 1 s");
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(EphemeralSessions, OfAProcessThatWasKilledEnd) {
    RunningServer running(ephemeral_after(std::chrono::seconds(1)));
    TcpProxy proxy(static_cast<std::uint16_t>(
        std::stoi(running.server.address().substr(running.server.address().rfind(':') + 1))));
    client::Client far(proxy.address());
    const std::string id = client::new_session_id();
    far.create_session(id, settings(), {.ephemeral = true});
    auto stream = far.stream(id);
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    auto watcher = running.client.watch(id);
    ASSERT_TRUE(watcher.next());
    proxy.cut();
    EXPECT_FALSE(watcher.next());
    EXPECT_EQ(watcher.end_reason(), "its simulator vanished, and no stream has come for 1 s");
    wait_until_gone(running);
}

TEST(EphemeralSessions, AreFoundByAStreamThatIsCutOffForLongerAndReconnects) {
    constexpr std::chrono::milliseconds soon(1000);
    RunningServer running(ephemeral_after(soon));
    const std::string& address = running.server.address();
    TcpProxy proxy(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    client::Client far(proxy.address());
    const std::string id = client::new_session_id();
    far.create_session(id, settings(), {.description = wave_pool, .ephemeral = true});
    const auto created_at = running.client.session(id).created_at;
    auto stream = far.stream(id, {.reconnect = std::chrono::seconds(60)});
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_EQ(stream.next()->index, 0U);
    proxy.refuse_for(2 * soon + soon / 2);
    stream.push(wave(4, 1.0).view(), 1, 0.0);
    EXPECT_EQ(stream.next()->index, 1U);
    EXPECT_EQ(running.client.session(id).created_at, created_at) << "the same session, not another of its id";
    EXPECT_EQ(running.client.session(id).frames, 2U);
}

TEST(EphemeralSessions, KeepTheirNameAndKindOnTheServerThatTakesThePlaceOfTheirs) {
    auto running = std::make_unique<RunningServer>(ephemeral_after(std::chrono::minutes(1)));
    const std::string address = running->server.address();
    client::Client client(address);
    const std::string id = client::new_session_id();
    client.create_session(id, settings(), {.description = wave_pool, .ephemeral = true});
    auto stream = client.stream(id, {.reconnect = std::chrono::seconds(60)});
    ServerOptions options = ephemeral_after(std::chrono::minutes(1));
    options.listen = address;
    running.reset();
    running = std::make_unique<RunningServer>(options);
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_EQ(stream.next()->index, 0U);
    expect_wave_pool(running->client.session(id).description);
    EXPECT_TRUE(running->client.session(id).ephemeral);
}

}  // namespace
}  // namespace meniscus::server::test
