// Frames that several streams send in parts: what comes of them does not depend on how they are dealt out.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "frames_with_arrays.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

/// Which part each particle comes in.
using Deal = std::function<std::size_t(std::size_t particle, std::size_t frame, std::size_t parts)>;

std::vector<std::pair<std::string, Deal>> deals() {
    return {
        {"at random, another way in each frame",
         [](std::size_t i, std::size_t frame, std::size_t parts) {
             std::mt19937 random(static_cast<std::uint32_t>(7919 * i + 31 * frame + parts));
             return random() % parts;
         }},
        {"all in one part, another one in each frame",
         [](std::size_t /*i*/, std::size_t frame, std::size_t parts) { return (frame + parts - 1) % parts; }},
        {"none in most parts",
         [](std::size_t i, std::size_t /*frame*/, std::size_t parts) { return i % 2 == 0 ? 0 : parts - 1; }},
        {"backwards", [](std::size_t i, std::size_t /*frame*/, std::size_t parts) { return (parts - 1) - i % parts; }}};
}

client::StreamOptions options_of(std::uint32_t part, std::uint32_t parts) {
    return {.spray = true,
            .attributes = {{.name = {}, .bits = 0}},
            .parts = parts,
            .part = part,
            .run = parts > 1 ? 0xfeedU : 0U};
}

/// What part 0 receives; the others are answered without meshes.
std::vector<std::string> exchange(RunningServer& running, const std::vector<Dealt>& frames, std::uint32_t parts,
                                  const Deal& deal) {
    const std::string id = client::new_session_id();
    running.client.create_session(id, all_settings());
    std::vector<std::string> received;
    std::vector<std::thread> uploaders;
    for (std::uint32_t p = 0; p < parts; ++p)
        uploaders.emplace_back([&, p] {
            auto stream = running.client.stream(id, options_of(p, parts));
            std::thread pusher([&] {
                for (std::size_t f = 0; f < frames.size(); ++f) {
                    std::vector<std::size_t> mine;
                    for (std::size_t i = 0; i < frames[f].count(); ++i)
                        if (deal(i, f, parts) == p) mine.push_back(i);
                    const Dealt part = frames[f].only(mine);
                    std::vector<ParticleArray> arrays;
                    stream.push(part.view(arrays), f, 0.1 * static_cast<double>(f));
                }
                stream.finish();
            });
            std::size_t answers = 0;
            while (const auto frame = stream.next()) {
                EXPECT_EQ(frame->index, answers++);
                if (p == 0) received.push_back(fingerprint(*frame));
            }
            EXPECT_EQ(answers, frames.size()) << "part " << p;
            pusher.join();
        });
    for (std::thread& uploader : uploaders) uploader.join();
    running.client.delete_session(id);
    return received;
}

TEST(PartsOfFrames, ChangeNoBitOfMeshesAttributesAndSprayHoweverTheyAreDealtOut) {
    RunningServer running;
    const std::vector<Dealt> frames = all_frames();
    const auto whole = exchange(running, frames, 1, [](auto...) { return std::size_t{0}; });
    ASSERT_EQ(whole.size(), frames.size());
    for (const std::uint32_t parts : {2U, 3U, 8U, 64U})
        for (const auto& [name, deal] : deals())
            EXPECT_EQ(exchange(running, frames, parts, deal), whole) << parts << " parts, " << name;
}

TEST(PartsOfFrames, AreOneFrameToWatchersAndInTheFiguresOfTheSession) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    const Particles particles = wave(7, 0.3);
    std::vector<std::thread> uploaders;
    for (std::uint32_t p = 0; p < 3; ++p)
        uploaders.emplace_back([&, p] {
            auto stream = running.client.stream(id, {.receive_meshes = false, .parts = 3, .part = p, .run = 9});
            Particles part;
            for (std::size_t i = p; i < particles.positions.size() / 3; i += 3)
                part.positions.insert(part.positions.end(),
                                      particles.positions.begin() + static_cast<std::ptrdiff_t>(3 * i),
                                      particles.positions.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
            stream.push(part.view(), 4, 0.0);
            stream.finish();
            EXPECT_EQ(stream.next()->statistics.particles, particles.positions.size() / 3);
            EXPECT_FALSE(stream.next());
        });
    const auto frame = watcher.next();
    for (std::thread& uploader : uploaders) uploader.join();
    ASSERT_TRUE(frame);
    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    EXPECT_EQ(running.client.session(id).frames, 1U);
}

/// Particles whose number says of which frame and part they are.
Particles marked(std::uint64_t frame, std::uint32_t part) {
    return wave(3 + (frame + part) % 3, static_cast<double>(10 * frame + part));
}

Particles joined(std::uint64_t frame, std::uint32_t parts) {
    Particles all;
    for (std::uint32_t p = 0; p < parts; ++p) {
        const Particles part = marked(frame, p);
        all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    }
    return all;
}

TEST(PartsOfFrames, ComeWholeAndOnceWhereAnyOfTheirConnectionsIsCut) {
    constexpr std::uint32_t parts = 3;
    constexpr std::uint64_t count = 30;
    RunningServer running(on_tcp());
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    std::vector<std::uint64_t> shown;
    std::thread watching([&] {
        while (shown.empty() || shown.back() + 1 < count) {
            const auto frame = watcher.next();
            if (!frame) return;
            shown.push_back(frame->index);
            EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(joined(frame->index, parts))) << frame->index;
        }
    });
    std::vector<std::thread> uploaders;
    for (std::uint32_t p = 0; p < parts; ++p)
        uploaders.emplace_back([&, p] {
            TcpProxy proxy(port_of(running.server.address()));
            client::Client far(proxy.address());
            auto stream = far.stream(
                id,
                {.receive_meshes = p == 0, .parts = parts, .part = p, .run = 77, .reconnect = std::chrono::minutes(1)});
            std::thread pusher([&] {
                for (std::uint64_t i = 0; i < count; ++i) stream.push(marked(i, p).view(), i, 0.0);
                stream.finish();
            });
            std::vector<std::uint64_t> answered;
            std::uint64_t frames = 0;
            while (const auto frame = stream.next()) {
                ++frames;
                for (const client::DroppedFrame& dropped : frame->dropped) {
                    EXPECT_EQ(dropped.reason, client::DropReason::incomplete);
                    answered.push_back(dropped.index);
                }
                answered.push_back(frame->index);
                if (frame->index % 9 == 2 * p) proxy.cut();
            }
            pusher.join();
            for (std::size_t i = 1; i < answered.size(); ++i)
                EXPECT_EQ(answered[i], answered[i - 1] + 1) << "part " << p;
            EXPECT_EQ(frames + stream.dropped(), count);  // dropped frames behind the last one are counted alone
        });
    for (std::thread& uploader : uploaders) uploader.join();
    watching.join();
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_LT(shown[i - 1], shown[i]);
}

/// A stream of part 1 of 2 that goes on where one before has broken off.
struct ResumedPart : RawStream {
    ResumedPart(const std::string& address, const std::string& id, std::uint64_t run)
        : RawStream(address, id, false, std::chrono::system_clock::now() + std::chrono::minutes(1)) {
        v1::StreamRequest request;
        v1::StreamOpen& open = *request.mutable_open();
        open.set_session_id(id);
        open.set_run_id(run);
        open.set_parts(2);
        open.set_part(1);
        open.set_resumes(true);
        call->Write(request);
    }
    void send_frame(std::uint64_t index) {
        send_begin(index, 1);
        send_chunk(12);
        send_end();
    }
    /// What is dropped until the end, which is a good one.
    std::vector<std::uint64_t> dropped_until_end() {
        v1::StreamRequest request;
        request.mutable_finish();
        call->Write(request);
        std::vector<std::uint64_t> dropped;
        for (v1::StreamResponse response; call->Read(&response);) {
            EXPECT_FALSE(response.has_frame_statistics());
            if (response.has_frame_dropped()) dropped.push_back(response.frame_dropped().frame_index());
        }
        const grpc::Status status = call->Finish();
        EXPECT_TRUE(status.ok()) << status.error_message();
        return dropped;
    }
};

TEST(PartsOfFrames, AreNotWaitedForByAPartThatHasMissedTheEndOfAll) {
    RunningServer running;
    const std::string id = running.session();
    constexpr std::uint64_t run = 5;
    for (std::uint64_t index = 0; index < 3; ++index) {
        std::vector<std::thread> uploaders;
        for (std::uint32_t p = 0; p < 2; ++p)
            uploaders.emplace_back([&, p] {
                auto stream = running.client.stream(id, {.parts = 2, .part = p, .run = run});
                stream.push(marked(index, p).view(), index, 0.0);
                stream.finish();
                const auto frame = stream.next();
                EXPECT_TRUE(frame && frame->index == index && frame->dropped.empty());
                EXPECT_FALSE(stream.next());
            });
        for (std::thread& uploader : uploaders) uploader.join();
        EXPECT_TRUE(ResumedPart(running.server.address(), id, run).dropped_until_end().empty());
        ResumedPart without_answer(running.server.address(), id, run);
        without_answer.send_frame(index);
        EXPECT_EQ(without_answer.dropped_until_end(), std::vector{index});
    }
    EXPECT_EQ(running.client.session(id).frames, 3U);
}

}  // namespace
}  // namespace meniscus::server::test
