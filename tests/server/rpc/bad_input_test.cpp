// The mistakes of clients, case by case: the status and message for each, and that nobody else notices.
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "meniscus/error.hpp"
#include "rpc/bad_input/case.hpp"
#include "sample_files.hpp"

namespace meniscus::server::test {
namespace {

std::vector<BadInputCase> all_cases() {
    std::vector<BadInputCase> all;
    for (auto part : {message_order_cases(), frame_cases(), array_cases(), position_cases(), open_cases(), part_cases(),
                      watch_cases(), session_cases(), recording_cases()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

void expect_answer(const BadInputCase& bad, RunningServer& running) {
    const grpc::Status status = bad.attempt(running);
    EXPECT_EQ(status.error_code(), bad.code) << status.error_message();
    EXPECT_NE(status.error_message().find(bad.message), std::string::npos) << status.error_message();
}

/// A session that streams on while others send what is bad.
struct HealthySession {
    explicit HealthySession(RunningServer& running) : stream(running.client.stream(running.session())) {}

    void expect_right_mesh() {
        const Particles particles = wave(5, static_cast<double>(next));
        stream.push(particles.view(), next++, 0.0);
        const auto frame = stream.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    }

    client::Stream stream;
    std::uint64_t next = 0;
};

struct BadInput : testing::TestWithParam<BadInputCase> {};

TEST_P(BadInput, GetsItsAnswer) {
    const meniscus::test::TemporaryDirectory recordings;
    RunningServer running(bad_input_options(recordings.path()));
    HealthySession healthy(running);
    expect_answer(GetParam(), running);
    healthy.expect_right_mesh();
}

INSTANTIATE_TEST_SUITE_P(Table, BadInput, testing::ValuesIn(all_cases()),
                         [](const auto& bad) { return bad.param.name; });

TEST(BadInputTable, LeavesAHealthySessionOfTheSameServerAsItWas) {
    const meniscus::test::TemporaryDirectory recordings;
    RunningServer running(bad_input_options(recordings.path()));
    HealthySession healthy(running);
    const std::vector<BadInputCase> cases = all_cases();
    EXPECT_GE(cases.size(), 60U);
    for (const BadInputCase& bad : cases) {
        SCOPED_TRACE(bad.name);
        expect_answer(bad, running);
        healthy.expect_right_mesh();
    }
    std::printf("%zu cases of bad input, %llu right meshes beside them\n", cases.size(),
                static_cast<unsigned long long>(healthy.next));
}

TEST(BadInputException, ReachesTheCallerOfPushAndNext) {
    const meniscus::test::TemporaryDirectory recordings;
    RunningServer running(bad_input_options(recordings.path()));
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    Particles bad = wave(3, 0.0);
    bad.positions[7] = std::numeric_limits<float>::quiet_NaN();
    stream.push(bad.view(), 0, 0.0);
    EXPECT_THROW(stream.next(), InvalidInput);
    EXPECT_THROW(stream.push(wave(3, 0.0).view(), 1, 0.0), InvalidInput);
    auto large = running.client.stream(id, {});
    EXPECT_THROW(
        {
            large.push(wave(101, 0.0).view(), 0, 0.0);
            large.next();
        },
        LimitExceeded);
    auto watcher = running.client.watch(id, {.normal_bits = 1});
    EXPECT_THROW(watcher.next(), InvalidInput);
}

TEST(MemoryLimit, RefusesAReconstructionThatWouldPassItAndLivesOn) {
    ServerOptions options = test_options();
    options.limits.bytes_per_session = 200'000;
    RunningServer running(options);
    const std::string id = running.session();
    for (int round = 0; round < 2; ++round) {
        auto stream = running.client.stream(id);
        stream.push(wave(20, 0.0).view(), 0, 0.0);
        EXPECT_THROW(stream.next(), LimitExceeded);
    }
    auto stream = running.client.stream(id);
    stream.push({}, 0, 0.0);
    EXPECT_TRUE(stream.next());
}

}  // namespace
}  // namespace meniscus::server::test
