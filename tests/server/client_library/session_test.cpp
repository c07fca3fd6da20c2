// Sessions that end with their owner.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

using client::ErrorCode;
using client::Session;

bool is_there(RunningServer& running, const std::string& id) {
    for (const client::SessionInfo& session : running.client.sessions())
        if (session.id == id) return true;
    return false;
}

std::chrono::steady_clock::duration time_to_let_go(std::optional<Session>& session) {
    const auto start = std::chrono::steady_clock::now();
    session.reset();
    return std::chrono::steady_clock::now() - start;
}

TEST(OwnedSession, EndsWithItsOwner) {
    RunningServer running;
    std::string id;
    {
        const Session session = running.client.open_session(settings());
        id = session.id();
        EXPECT_TRUE(session.is_owned());
        EXPECT_TRUE(is_there(running, id));
    }
    EXPECT_FALSE(is_there(running, id));
}

TEST(OwnedSession, LeavesASessionThatWasThereBefore) {
    RunningServer running;
    const std::string id = running.session();
    {
        Session session = running.client.open_session(settings(), {.id = id});
        EXPECT_FALSE(session.is_owned());
        session.end();
    }
    EXPECT_TRUE(is_there(running, id));
}

TEST(OwnedSession, LeavesASessionThatCameInItsPlace) {
    RunningServer running;
    std::optional<Session> first = running.client.open_session(settings());
    std::optional<Session> late = running.client.open_session(settings());
    const std::string id = first->id();
    const std::string id_of_late = late->id();
    for (const std::string& one : {id, id_of_late}) {
        running.client.delete_session(one);
        running.client.create_session(one, settings(), {.ephemeral = true});
    }
    first->end();
    late->stream();
    EXPECT_FALSE(late->is_owned());
    first.reset();
    late.reset();
    EXPECT_TRUE(is_there(running, id));
    EXPECT_TRUE(is_there(running, id_of_late));
}

TEST(OwnedSession, CanBeEndedFromElsewhereAsByItself) {
    RunningServer running;
    std::optional<Session> session = running.client.open_session(settings());
    const std::string id = session->id();
    const std::function<void()> end = session->ending();
    end();
    EXPECT_FALSE(is_there(running, id));
    EXPECT_NO_THROW(end());
    // Somebody else's.
    running.client.create_session(id, settings());
    end();
    session.reset();
    end();
    EXPECT_TRUE(is_there(running, id));
    Session joined = running.client.open_session(settings(), {.id = id});
    joined.ending()();
    EXPECT_TRUE(is_there(running, id));
    // After its owner, on another thread.
    std::optional<Session> left = running.client.open_session(settings(), {.ephemeral = false});
    const std::string id_of_left = left->id();
    const std::function<void()> end_left = left->ending();
    left->leave();
    left.reset();
    ASSERT_TRUE(is_there(running, id_of_left));
    std::thread(end_left).join();
    EXPECT_FALSE(is_there(running, id_of_left));
}

TEST(OwnedSession, StaysWhenItIsLeft) {
    RunningServer running;
    std::string id;
    {
        Session session = running.client.open_session(settings(), {.ephemeral = false});
        id = session.id();
        session.leave();
        EXPECT_FALSE(session.is_owned());
    }
    EXPECT_TRUE(is_there(running, id));
}

TEST(OwnedSession, IsCreatedWithItsDescriptionAndEphemeralUnlessToldOtherwise) {
    RunningServer running;
    Session session = running.client.open_session(
        settings(), {.description = {.name = "dam", .up_axis = client::UpAxis::y, .length_unit = "m"}});
    const client::SessionInfo info = session.info();
    EXPECT_EQ(info.id, session.id());
    EXPECT_EQ(info.description.name, "dam");
    EXPECT_EQ(info.description.up_axis, client::UpAxis::y);
    EXPECT_EQ(info.description.length_unit, "m");
    EXPECT_TRUE(info.ephemeral);
    EXPECT_FALSE(running.client.open_session(settings(), {.ephemeral = false}).info().ephemeral);
}

TEST(OwnedSession, EndsWhenItIsToldToAndForgivesASessionThatHasGone) {
    RunningServer running;
    Session session = running.client.open_session(settings());
    session.end();
    EXPECT_FALSE(is_there(running, session.id()));
    EXPECT_FALSE(session.is_owned());
    Session gone = running.client.open_session(settings());
    running.client.delete_session(gone.id());
    EXPECT_NO_THROW(gone.end());
}

TEST(OwnedSession, EndsWhenAnotherTakesItsPlace) {
    RunningServer running;
    Session session = running.client.open_session(settings());
    const std::string first = session.id();
    session = running.client.open_session(settings());
    EXPECT_FALSE(is_there(running, first));
    EXPECT_TRUE(is_there(running, session.id()));
}

TEST(OwnedSession, MayGoBeforeOrAfterItsStreamItsWatcherAndItsClient) {
    RunningServer running;
    for (int order = 0; order < 6; ++order) {
        auto client = std::make_unique<client::Client>(running.server.address());
        std::optional<Session> session = client->open_session(settings());
        const std::string id = session->id();
        std::optional<client::Stream> stream = session->stream({.reconnect = std::chrono::seconds(60)});
        std::optional<client::Watcher> watcher = session->watch();
        if (order == 4) client.reset();
        stream->push(wave(4, 0.0).view(), 0, 0.0);
        ASSERT_TRUE(stream->next());
        ASSERT_TRUE(watcher->next());
        if (order % 2 == 0) stream.reset();
        if (order == 1 || order == 4) watcher.reset();
        if (order == 3) client.reset();
        session.reset();
        EXPECT_FALSE(is_there(running, id)) << order;
        if (watcher) {
            EXPECT_FALSE(watcher->next()) << order;
        }
        if (stream) {
            EXPECT_THROW(stream->next(), client::ServerError) << order;
        }
    }
}

TEST(OwnedSession, IsOpenedAgainForAStreamWhereTheServerHasEndedItMeanwhile) {
    RunningServer running;
    Session session = running.client.open_session(settings());
    running.client.delete_session(session.id());
    auto stream = session.stream();
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    EXPECT_TRUE(stream.next());
    EXPECT_TRUE(session.info().ephemeral);
}

TEST(OwnedSession, KeepsItsNameAndKindWhenItsStreamCreatesItAgain) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    const std::uint16_t port = port_of(running->server.address());
    client::Client client("127.0.0.1:" + std::to_string(port));
    Session session = client.open_session(settings(), {.description = {.name = "dam"}});
    auto stream = session.stream({.reconnect = std::chrono::seconds(60)});
    running.reset();
    running = std::make_unique<RunningServer>(on_tcp(port));
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    EXPECT_EQ(session.info().description.name, "dam");
    EXPECT_TRUE(session.info().ephemeral);
}

TEST(OwnedSession, GoesWithinASecondWhereItsServerIsGoneOrSilent) {
    using namespace std::chrono_literals;
    auto running = std::make_unique<RunningServer>(on_tcp());
    client::Client client(running->server.address());
    std::optional<Session> deserted = client.open_session(settings());
    TcpProxy proxy(port_of(running->server.address()));
    client::Client far(proxy.address());
    std::optional<Session> unheard = far.open_session(settings());
    proxy.swallow();
    EXPECT_LT(time_to_let_go(unheard), 1s);
    running.reset();
    EXPECT_LT(time_to_let_go(deserted), 1s);
}

}  // namespace
}  // namespace meniscus::server::test
