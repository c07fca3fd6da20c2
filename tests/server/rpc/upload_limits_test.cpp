// Limits of uploading streams over a real connection: exactly at each, and one past it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

constexpr auto exhausted = grpc::StatusCode::RESOURCE_EXHAUSTED;

struct UploadLimits : testing::Test {
    struct Outcome {
        grpc::Status status;
        int answered = 0;
    };
    static Outcome outcome(RawStream& stream) {
        stream.call->WritesDone();
        const grpc::Status status = stream.finish();
        return {status, stream.answered};
    }
    static void expect_refused(const grpc::Status& status, const std::string& words) {
        EXPECT_EQ(status.error_code(), exhausted);
        EXPECT_NE(status.error_message().find(words), std::string::npos) << status.error_message();
    }

    ServerOptions options = test_options();
};

TEST_F(UploadLimits, ChunksPerFrame) {
    options.limits.chunks_per_frame = 4;
    RunningServer running(options);
    for (const int extra : {0, 1}) {
        RawStream stream(running.server.address(), running.session());
        stream.send_begin(0, 1);
        stream.send_chunk(12);
        for (int i = 0; i < 3 + extra; ++i) stream.send_chunk(0);
        stream.send_end();
        const Outcome result = outcome(stream);
        EXPECT_EQ(result.answered, 1 - extra);
        if (extra == 0)
            EXPECT_TRUE(result.status.ok()) << result.status.error_message();
        else
            expect_refused(result.status, "frame 0: more than 4 chunks; the server takes at most 4 per frame");
    }
}

TEST_F(UploadLimits, FramesPerSecond) {
    options.limits.frames_per_second = 3;
    RunningServer running(options);
    for (const std::uint64_t frames : {3U, 300U}) {
        RawStream stream(running.server.address(), running.session());
        for (std::uint64_t i = 0; i < frames; ++i) {
            stream.send_begin(i, 0);
            stream.send_end();
        }
        const Outcome result = outcome(stream);
        EXPECT_GE(result.answered, 3);
        if (frames == 3)
            EXPECT_TRUE(result.status.ok()) << result.status.error_message();
        else
            expect_refused(result.status, "more than 3 frames in a second");
    }
}

TEST_F(UploadLimits, BytesInFlightThatAreOnlyAnnouncedCostOthersNothing) {
    options.limits.bytes_in_flight = 240;
    RunningServer running(options);
    RawStream first(running.server.address(), running.session());
    RawStream second(running.server.address(), running.session());
    for (RawStream* holds : {&first, &second}) {
        holds->send_begin(0, 20);
        holds->send_chunk(1);
    }
    const auto send = [&](std::uint64_t particles) {
        RawStream stream(running.server.address(), running.session());
        stream.send_begin(0, particles);
        stream.send_chunk(12 * particles);
        stream.send_end();
        return outcome(stream);
    };
    for (const std::uint64_t particles : {1U, 3U, 4U, 10U, 15U}) {
        const Outcome result = send(particles);
        EXPECT_TRUE(result.status.ok()) << particles << ": " << result.status.error_message();
    }
    expect_refused(send(21).status, "frame 0: a frame of 252 bytes; the server takes at most 240 bytes");
    for (RawStream* holds : {&first, &second}) {
        holds->send_chunk(239);
        holds->send_end();
        holds->call->WritesDone();
    }
    EXPECT_TRUE(first.finish().ok());
    EXPECT_TRUE(second.finish().ok());
}

TEST_F(UploadLimits, LargeFramesOfTwoSessionsBothArrive) {
    const Particles particles = wave(20, 0.0);
    const std::size_t bytes = particles.positions.size() * sizeof(float);
    options.limits.bytes_in_flight = bytes * 10 / 6;
    RunningServer running(options);
    std::vector<std::thread> senders;
    std::array<grpc::Status, 4> ends;
    senders.reserve(ends.size());
    for (grpc::Status& end : ends)
        senders.emplace_back([&, id = running.session()] {
            RawStream stream(running.server.address(), id);
            for (std::uint64_t frame = 0; frame < 3; ++frame) {
                stream.send_begin(frame, particles.positions.size() / 3);
                for (std::size_t at = 0; at < bytes; at += 4096)
                    stream.send_data(std::string{reinterpret_cast<const char*>(particles.positions.data()) + at,
                                                 std::min<std::size_t>(4096, bytes - at)});
                stream.send_end();
            }
            end = outcome(stream).status;
        });
    for (std::thread& sender : senders) sender.join();
    for (const grpc::Status& end : ends) EXPECT_TRUE(end.ok()) << end.error_message();
}

TEST_F(UploadLimits, TimeOfAFrameThatComesTooSlowly) {
    options.limits.least_pace = {.time = std::chrono::milliseconds(200), .bytes_per_second = 1000};
    RunningServer running(options);
    const std::string id = running.session();
    RawStream stream(running.server.address(), id);
    stream.send_begin(0, 0);
    stream.send_end();
    stream.send_begin(1, 1000);
    stream.send_chunk(1);
    const grpc::Status status = stream.finish();
    EXPECT_EQ(stream.answered, 1) << "the frames before are answered";
    expect_refused(status, "frame 1: 1 of 12000 bytes in ");
    expect_refused(status, "within 0.2 s, or come with 1000 bytes per second from then on");
    EXPECT_FALSE(running.client.session(id).uploading) << "another stream may follow";
}

/// Sends frames as long as it may, and reads nothing by itself.
class DeafSimulator {
public:
    DeafSimulator(const std::string& address, const std::string& id, const Particles& particles)
        : stream_(address, id, false, in_five_minutes()) {
        v1::StreamRequest open;
        open.mutable_open()->set_session_id(id);
        open.mutable_open()->set_receive_meshes(true);
        stream_.call->Write(open);
        thread_ = std::thread([this, &particles] {
            v1::StreamRequest chunk;
            chunk.mutable_frame_chunk()->set_data(bytes_of(particles));
            for (std::uint64_t frame = 0; !enough_; ++frame) {
                stream_.send_begin(frame, particles.positions.size() / 3);
                if (!stream_.call->Write(chunk)) return;
                stream_.send_end();
            }
            stream_.call->WritesDone();
        });
    }
    ~DeafSimulator() {
        stream_.context.TryCancel();
        if (thread_.joinable()) thread_.join();
    }

    static std::string bytes_of(const Particles& particles) {
        return {reinterpret_cast<const char*>(particles.positions.data()), particles.positions.size() * sizeof(float)};
    }
    /// A guard: far more than it takes, under a sanitizer too.
    static std::chrono::system_clock::time_point in_five_minutes() {
        return std::chrono::system_clock::now() + std::chrono::minutes(5);
    }

    void wait_until_it_may_not_send() { thread_.join(); }
    /// The frame on its way is the last, and from here on it reads.
    grpc::Status finish() {
        enough_ = true;
        return stream_.finish();
    }
    int answered() const { return stream_.answered; }

private:
    RawStream stream_;
    std::atomic<bool> enough_ = false;
    std::thread thread_;
};

TEST_F(UploadLimits, TimeOfAnswersThatNobodyTakesWhileFramesOfOthersWait) {
    const Particles particles = wave(20, 0.0);
    options.limits.bytes_in_flight = 2 * particles.positions.size() * sizeof(float);
    options.limits.least_pace = {.time = std::chrono::milliseconds(200), .bytes_per_second = 1000};
    RunningServer running(options);
    for (const bool reads_at_last : {true, false}) {
        SCOPED_TRACE(reads_at_last);
        const std::string id = running.session();
        const std::string another = running.session();
        DeafSimulator deaf(running.server.address(), id, particles);
        while (running.client.session(id).frames == 0) std::this_thread::yield();
        for (bool all_went_well = true; all_went_well && running.client.session(id).uploading;) {
            RawStream other(running.server.address(), another, true, DeafSimulator::in_five_minutes());
            other.send_begin(0, particles.positions.size() / 3);
            other.send_data(DeafSimulator::bytes_of(particles));
            other.send_end();
            const Outcome result = outcome(other);
            all_went_well = result.status.ok();
            EXPECT_TRUE(all_went_well) << result.status.error_message();
        }
        if (!reads_at_last) deaf.wait_until_it_may_not_send();
        const grpc::Status status = deaf.finish();
        if (reads_at_last) {
            expect_refused(status, " bytes of the meshes were taken in 0.");
            expect_refused(status, "take the first within 0.2 s, or 1000 bytes per second from then on");
        } else {
            EXPECT_EQ(status.error_code(), grpc::StatusCode::CANCELLED) << "it could not be told";
        }
        RawStream next(running.server.address(), id, true, DeafSimulator::in_five_minutes());
        EXPECT_TRUE(outcome(next).status.ok()) << "another stream may follow";
    }
}

TEST_F(UploadLimits, OfAnswersThatNobodyTakesAreNoneWhileNobodyElseWaits) {
    const Particles particles = wave(20, 0.0);
    // So that its own next frame waits for the bytes of the one before.
    options.limits.bytes_in_flight = particles.positions.size() * sizeof(float) * 3 / 2;
    options.limits.least_pace = {.time = std::chrono::milliseconds(40), .bytes_per_second = 1'000'000'000};
    RunningServer running(options);
    const std::string id = running.session();
    DeafSimulator deaf(running.server.address(), id, particles);
    using Clock = std::chrono::steady_clock;
    const auto waits = [&] { return running.client.session(id).waits_for == client::SessionWait::bytes_in_flight; };
    for (Clock::time_point since = Clock::now(); Clock::now() - since < std::chrono::milliseconds(400);)
        if (!waits()) since = Clock::now();
    EXPECT_TRUE(deaf.finish().ok());
    EXPECT_EQ(deaf.answered(), static_cast<int>(running.client.session(id).frames));
}

TEST_F(UploadLimits, MessageBytes) {
    constexpr std::size_t chunk = 16384;
    options.limits.message_bytes = chunk + 1024;
    RunningServer running(options);
    const std::string id = running.session();
    for (const std::size_t bytes : {chunk, chunk + 2000}) {
        RawStream stream(running.server.address(), id);
        stream.send_begin(0, chunk / 4);
        stream.send_chunk(bytes);
        if (bytes == chunk) {
            stream.send_chunk(chunk);
            stream.send_chunk(chunk);
            stream.send_end();
        }
        const Outcome result = outcome(stream);
        EXPECT_EQ(result.answered, bytes == chunk ? 1 : 0);
        EXPECT_EQ(result.status.ok(), bytes == chunk) << result.status.error_message();
    }
}

TEST_F(UploadLimits, IdleTime) {
    options.limits.idle_time = std::chrono::seconds(1);
    RunningServer running(options);
    const std::string id = running.session();
    RawStream stream(running.server.address(), id);
    stream.send_begin(0, 0);
    stream.send_end();
    const grpc::Status status = stream.finish();
    EXPECT_EQ(stream.answered, 1);
    expect_refused(status, "the server keeps an idle stream for 1 s");
    while (!running.client.sessions().empty()) std::this_thread::yield();
}

TEST_F(UploadLimits, AreWhatTheServerSays) {
    options.limits = Limits{.bytes_in_flight = 1,
                            .frames_per_second = 2,
                            .chunks_per_frame = 3,
                            .idle_time = std::chrono::milliseconds(4500),
                            .message_bytes = 5'000'000};
    RunningServer running(options);
    client::Connection connection(running.server.address());
    grpc::ClientContext context;
    v1::GetServerInfoResponse response;
    ASSERT_TRUE(connection.server->GetServerInfo(&context, {}, &response).ok());
    EXPECT_EQ(response.limits().bytes_in_flight(), 1U);
    EXPECT_EQ(response.limits().frames_per_second(), 2U);
    EXPECT_EQ(response.limits().chunks_per_frame(), 3U);
    EXPECT_EQ(response.limits().idle_seconds(), 4.5);
    EXPECT_EQ(response.limits().message_bytes(), 5'000'000U);
}

TEST_F(UploadLimits, OfAMessageLeaveTheSessionFreeForTheNextStreamAtOnce) {
    RunningServer running;
    const std::string id = running.session();
    for (int i = 0; i < 50; ++i) {
        RawStream large(running.server.address(), id);
        large.send_begin(0, 1'000'000);
        large.send_chunk(std::size_t{5} << 20U);
        const grpc::Status refused = large.finish();
        EXPECT_EQ(refused.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << refused.error_message();
        RawStream next(running.server.address(), id);
        next.call->WritesDone();
        const grpc::Status status = next.finish();
        ASSERT_TRUE(status.ok()) << "attempt " << i << ": " << status.error_message();
    }
}

TEST_F(UploadLimits, OfOneStreamForEachSessionAreKept) {
    RunningServer running;
    const std::string id = running.session();
    RawStream first(running.server.address(), id);
    first.call->WaitForInitialMetadata();
    RawStream second(running.server.address(), id);
    const grpc::Status refused = second.finish();
    EXPECT_EQ(refused.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
    EXPECT_NE(refused.error_message().find("another stream uploads to session " + id), std::string::npos);
    first.call->WritesDone();
    EXPECT_TRUE(first.finish().ok());
}

}  // namespace
}  // namespace meniscus::server::test
