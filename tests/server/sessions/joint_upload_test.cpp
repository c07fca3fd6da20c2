// Frames that come in parts: they are whole or not at all, whatever their streams do, and nothing is left behind.
#include "sessions/session/joint_upload.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "meniscus/error.hpp"
#include "part_player.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"
#include "simulator_player.hpp"

namespace meniscus::server::test {
namespace {

using Answers = std::vector<std::string>;

/// Particles of a part, also none.
std::size_t particles_in(std::uint64_t index, std::uint32_t part) {
    return (7 * index + 5 * part) % 11;
}

std::vector<SentFrame> frames_of(std::uint32_t part, const std::vector<std::uint64_t>& indices) {
    std::vector<SentFrame> frames;
    frames.reserve(indices.size());
    for (const std::uint64_t index : indices)
        frames.push_back({.index = index, .particles = particles_in(index, part)});
    return frames;
}

/// A session that notes which frames were whole, and which were not.
struct CheckedSession {
    CheckedSession(std::uint32_t parts, std::shared_ptr<BytesInFlight> bytes, const Limits& with = {})
        : limits(with),
          session(std::make_shared<Session>(
              SessionIdentity{.id = id}, settings(), limits,
              ReconstructFunctions{.reconstruct =
                                       [this, parts](const ParticleFrame& frame, Mesh& mesh) {
                                           note(frame, parts);
                                           mesh = {};
                                           return Statistics{};
                                       }},
              SharedResources{.workers = std::make_shared<WorkerPool>(1), .bytes_in_flight = std::move(bytes)})) {}

    ~CheckedSession() { end(); }
    CheckedSession(const CheckedSession&) = delete;
    CheckedSession& operator=(const CheckedSession&) = delete;

    /// As the registry does it: a stream may have the last reference.
    void end() const {
        session->close();
        session->join();
    }

    void note(const ParticleFrame& frame, std::uint32_t parts) {
        std::map<float, std::map<float, std::size_t>> counts;  // by index and part
        for (std::size_t i = 0; i + 2 < frame.positions.size(); i += 3) {
            const std::size_t number = counts[frame.positions[i]][frame.positions[i + 1]]++;
            mixed += frame.positions[i + 2] != static_cast<float>(number) ? 1 : 0;
        }
        if (counts.size() > 1) ++mixed;
        for (const auto& [index, of_parts] : counts)
            for (std::uint32_t part = 0; part < parts; ++part) {
                const auto found = of_parts.find(static_cast<float>(part));
                const std::size_t count = found != of_parts.end() ? found->second : 0;
                mixed += count != particles_in(static_cast<std::uint64_t>(index), part) ? 1 : 0;
            }
    }

    Limits limits;
    std::atomic<int> mixed{0};
    std::shared_ptr<Session> session;
};

UploadOptions in_parts(std::uint32_t parts, UploadPolicy policy = UploadPolicy::every_frame) {
    return {.policy = policy, .run_id = 7, .parts = parts, .reconnect = std::chrono::minutes(1)};
}

struct Parts : testing::Test {
    std::shared_ptr<BytesInFlight> bytes = std::make_shared<BytesInFlight>();
    CheckedSession checked{3, bytes};

    std::shared_ptr<PartPlayer> player(std::uint32_t part, const std::vector<std::uint64_t>& indices) const {
        return std::make_shared<PartPlayer>(checked.limits, part, frames_of(part, indices), part);
    }
    std::shared_ptr<PartPlayer> opened(std::uint32_t part, const std::vector<std::uint64_t>& indices,
                                       const UploadOptions& options = in_parts(3)) const {
        auto made = player(part, indices);
        made->open(checked.session, options);
        return made;
    }
    static void play(const std::vector<std::shared_ptr<PartPlayer>>& players) {
        std::vector<std::thread> threads;
        threads.reserve(players.size());
        for (const auto& each : players)
            threads.emplace_back([each] {
                each->play(0);
                each->done(UploadEnd::answered);
            });
        for (std::thread& thread : threads) thread.join();
    }
    static std::string text_of(const std::exception_ptr& error) {
        try {
            if (error) std::rethrow_exception(error);
        } catch (const std::exception& thrown) {
            return thrown.what();
        }
        return "none";
    }
};

TEST_F(Parts, AreOneFrameToTheSessionAndEachIsAnswered) {
    const std::vector players{opened(2, {1, 2, 3}), opened(0, {1, 2, 3}), opened(1, {1, 2, 3})};
    play(players);
    for (const auto& each : players) {
        EXPECT_EQ(each->answers, (Answers{"1", "2", "3"}));
        EXPECT_EQ(text_of(each->error), "none");
    }
    EXPECT_EQ(checked.session->state().frames, 3U);
    EXPECT_EQ(checked.mixed, 0);
}

TEST_F(Parts, ThatAreSentByFewerAreToldToThoseAndPassedOver) {
    const std::vector players{opened(0, {1, 2, 5, 6}), opened(1, {2, 4, 5, 7}), opened(2, {2, 5})};
    play(players);
    EXPECT_EQ(players[0]->answers, (Answers{"-1", "2", "5", "-6"}));
    EXPECT_EQ(players[1]->answers, (Answers{"2", "-4", "5", "-7"}));
    EXPECT_EQ(players[2]->answers, (Answers{"2", "5"}));
    EXPECT_EQ(checked.session->state().frames, 2U);
    EXPECT_EQ(checked.mixed, 0);
}

TEST_F(Parts, AreDroppedForAllOrForNoneByAPolicy) {
    UploadOptions options = in_parts(3, UploadPolicy::every_nth);
    options.nth = 2;
    const std::vector players{opened(0, {1, 2, 3, 4}, options), opened(1, {1, 2, 3, 4}, options),
                              opened(2, {1, 2, 3, 4}, options)};
    play(players);
    for (const auto& each : players) EXPECT_EQ(each->answers, (Answers{"1", "-2", "3", "-4"}));
    EXPECT_EQ(checked.session->state().frames_dropped_not_nth, 2U);
}

TEST_F(Parts, AreSentByOneStreamEach) {
    const auto first = opened(1, {});
    EXPECT_THROW(opened(1, {}), Refusal);
    try {
        opened(1, {});
    } catch (const Refusal& refusal) {
        EXPECT_EQ(refusal.kind(), Refusal::Kind::failed_precondition);
        EXPECT_EQ(std::string(refusal.what()),
                  fmt::format("part 1 of 3 uploads to session {} already; each part is sent by one stream", id));
    }
    first->done(UploadEnd::vanished);
    EXPECT_NO_THROW(opened(1, {})) << "the run is resumed";
}

TEST_F(Parts, ComeAgainOverAnotherStreamAlsoBeforeTheFirstFrameOfAResumedRun) {
    const std::vector players{opened(0, {1}), opened(1, {1}), opened(2, {1})};
    std::vector<std::thread> threads;
    for (const auto& each : players) {
        each->stays = true;
        threads.emplace_back([each] {
            each->play(0);
            each->done(UploadEnd::vanished);
        });
    }
    for (std::thread& thread : threads) thread.join();
    const auto half_open = opened(1, {2});
    EXPECT_NO_THROW(opened(1, {2}));
}

TEST_F(Parts, GoOnInTheSameRunAfterAllHaveEndedWell) {
    play({opened(0, {1}), opened(1, {1}), opened(2, {1})});
    const auto first = opened(0, {2, 3});
    EXPECT_EQ(first->upload().missing_parts, 2U) << "their frames are waited for";
    play({first, opened(1, {2, 3}), opened(2, {2, 3})});
    EXPECT_EQ(first->answers, (Answers{"2", "3"}));
}

TEST_F(Parts, OfAnotherRunAreRefused) {
    const auto first = opened(1, {});
    UploadOptions other = in_parts(3);
    other.run_id = 8;
    EXPECT_THROW(opened(2, {}, other), Refusal);
}

TEST_F(Parts, SayTheSameOfTheFrames) {
    const auto first = opened(1, {});
    UploadOptions more = in_parts(4);
    UploadOptions latest = in_parts(3, UploadPolicy::latest);
    UploadOptions impatient = in_parts(3);
    impatient.reconnect = std::chrono::seconds(1);
    for (const UploadOptions& other : {more, latest, impatient}) EXPECT_THROW(opened(2, {}, other), InvalidInput);
    try {
        opened(3, {}, more);
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(), "part 3 says parts 4, the parts before it 3; it is the same for all parts");
    }
}

struct SilentStream : PartStream {
    void wake() override {}
    void read_next() override {}
    void begun(std::optional<std::vector<FramePiece>> /*pieces*/) override {}
    void stop_reading() override {}
};

/// The session keeps an upload whose frame has failed.
TEST(JointUploads, ThatWaitForTheirDropsToBeReportedHoldNoSession) {
    std::optional<CheckedSession> checked(std::in_place, 1, std::make_shared<BytesInFlight>());
    const std::weak_ptr<Session> session = checked->session;
    const auto stream = std::make_shared<SilentStream>();
    auto joint = JointUpload::open(checked->session, {.policy = UploadPolicy::latest}, 0, stream);
    const std::shared_ptr<Upload> upload = joint->upload();
    for (std::size_t i = 0; i < UnreportedDrops::limit; ++i) upload->unreported_drops.add();
    joint->ready(0);
    joint->done(0, UploadEnd::vanished);
    joint = nullptr;
    checked.reset();
    EXPECT_TRUE(session.expired());
    upload->unreported_drops.report();
}

TEST_F(Parts, EndTogetherWhereOneBreaksOff) {
    const auto broken = opened(1, {1});
    const auto other = opened(0, {1});
    const auto third = opened(2, {1});
    std::thread waits([&] { other->play(0); });
    broken->done(UploadEnd::vanished);
    waits.join();
    EXPECT_EQ(text_of(other->error),
              "part 1 of 3 has broken off: the frames without an answer are dropped for all parts");
    EXPECT_TRUE(other->answers.empty());
    EXPECT_FALSE(checked.session->state().uploading);
    EXPECT_TRUE(third->play(0) == PartPlayer::Outcome::ended);
    try {
        std::rethrow_exception(other->error);
    } catch (const Refusal& refusal) {
        EXPECT_EQ(refusal.kind(), Refusal::Kind::aborted) << "clients that reconnect come again";
    }
}

TEST_F(Parts, GiveWayToOneThatComesAgainBeforeItsBreakIsNoticed) {
    const auto silent = opened(1, {1, 2});
    const auto other = opened(0, {1, 2});
    const auto third = opened(2, {1, 2});
    std::vector<std::thread> threads;
    for (const auto& each : {silent, other, third}) {
        each->stays = true;
        threads.emplace_back([each] { each->play(0); });
    }
    for (std::thread& thread : threads) thread.join();
    const auto again = opened(1, {3});
    other->stays = false;
    other->play(0);
    EXPECT_EQ(
        text_of(other->error),
        "part 1 of 3 has come again, over another stream: the frames without an answer are dropped for all parts");
    for (const auto& each : {silent, other, third}) each->done(UploadEnd::vanished);
    play({again, opened(0, {3}), opened(2, {3})});
    EXPECT_EQ(again->answers, (Answers{"3"}));
    EXPECT_EQ(checked.mixed, 0);
}

TEST_F(Parts, ThatDoNotComeEndTheOthersInTheTimeOfOrphans) {
    Limits limits;
    limits.orphan_time = std::chrono::seconds(100);
    CheckedSession waiting(3, bytes, limits);
    const auto lonely = player(1, {1});
    lonely->open(waiting.session, in_parts(3));
    const auto now = std::chrono::steady_clock::now();
    waiting.session->end_idle_upload(now + std::chrono::seconds(90), false);
    EXPECT_TRUE(waiting.session->state().uploading);
    waiting.session->end_idle_upload(now + std::chrono::seconds(101), false);
    EXPECT_FALSE(waiting.session->state().uploading);
    lonely->play(0);
    EXPECT_EQ(text_of(lonely->error).substr(0, 53), "2 of the 3 parts of the frames have not come for 101 ");
    lonely->done(UploadEnd::answered);
    // Its simulator has vanished, if for a part. Asserts by ending.
    while (!waiting.session->unused(std::chrono::steady_clock::now() + limits.orphan_time)) std::this_thread::yield();
}

TEST_F(Parts, ThatComputeAreNotIdleWhileOthersWaitForThem) {
    const std::vector players{opened(0, {1}), opened(1, {1})};
    std::vector<std::thread> waiting;
    waiting.reserve(players.size());
    for (const auto& each : players) waiting.emplace_back([each] { each->play(0); });
    const auto computes = opened(2, {1});
    while (!players[0]->upload().waits_for_parts) std::this_thread::yield();
    checked.session->end_idle_upload(std::chrono::steady_clock::now() + 2 * checked.limits.idle_time, false);
    play({computes});
    for (std::thread& thread : waiting) thread.join();
    for (const auto& each : players) EXPECT_EQ(each->answers, (Answers{"1"}));
}

/// Lets the server begin to stop when another stream has taken its place.
struct DrainingStream final : SilentStream {
    explicit DrainingStream(Session& of) : session(of) {}
    void wake() override { session.drain(std::chrono::seconds(1)); }

    Session& session;
};

TEST_F(Parts, EndWhereTheServerStopsWhileTheyAreOpened) {
    const auto before = std::make_shared<DrainingStream>(*checked.session);
    const auto joint = JointUpload::open(checked.session, in_parts(1), 0, before);
    const auto after = opened(0, {1}, in_parts(1));
    EXPECT_TRUE(after->play(0) == PartPlayer::Outcome::ended);
    EXPECT_EQ(text_of(after->error), "the server is shutting down");
    joint->done(0, UploadEnd::vanished);
    after->done(UploadEnd::answered);
}

TEST_F(Parts, CountOnceToTheFramesOfASecond) {
    Limits limits;
    limits.frames_per_second = 2;
    CheckedSession limited(3, bytes, limits);
    std::vector<std::shared_ptr<PartPlayer>> players;
    for (const std::uint32_t part : {0U, 1U, 2U}) {
        players.push_back(player(part, {1, 2}));
        players.back()->open(limited.session, in_parts(3));
    }
    play(players);
    for (const auto& each : players) EXPECT_EQ(each->answers, (Answers{"1", "2"}));
}

/// Uploads until each frame is answered, over as many connections as that takes.
void upload(const CheckedSession& checked, std::uint32_t part, std::uint32_t parts, unsigned seed, unsigned breaks,
            UploadPolicy policy, Answers& answers) {
    constexpr std::uint64_t frames = 12;
    std::mt19937 random(seed);
    std::uint64_t first = 0;
    for (int attempt = 0;; ++attempt) {
        std::vector<std::uint64_t> indices;
        for (std::uint64_t index = first; index < frames; ++index) indices.push_back(index);
        const auto stream = std::make_shared<PartPlayer>(checked.limits, part, frames_of(part, indices), random());
        try {
            stream->open(checked.session, in_parts(parts, policy));
        } catch (const Refusal&) {  // its connection before is not known to be broken, and no frame has begun
            std::this_thread::yield();
            continue;
        }
        const auto outcome = stream->play(attempt < 6 ? breaks : 0);
        answers.insert(answers.end(), stream->answers.begin(), stream->answers.end());
        first += stream->answers.size();
        stream->done(outcome == PartPlayer::Outcome::broken ? UploadEnd::vanished : UploadEnd::answered);
        if (outcome == PartPlayer::Outcome::ended && !stream->error) return;
    }
}

TEST(PartsAtRandom, AreWholeOrDroppedAndNothingIsLeftOfThemWhateverBreaks) {
    for (unsigned seed = 0; seed < 60; ++seed) {
        const std::uint32_t parts = 1 + seed % 4;
        const unsigned breaks = seed % 3 == 0 ? 0 : 25 * parts;
        // Two sessions wait for each other's bytes: the largest frames have more than half.
        const auto bytes = std::make_shared<BytesInFlight>(600, 2);
        const auto policy = seed % 5 == 4 ? UploadPolicy::latest : UploadPolicy::every_frame;
        std::array<CheckedSession, 2> sessions{CheckedSession(parts, bytes), CheckedSession(parts, bytes)};
        std::vector<Answers> answers(2 * parts);
        std::vector<std::thread> uploaders;
        for (std::size_t s = 0; s < 2; ++s)
            for (std::uint32_t part = 0; part < parts; ++part)
                uploaders.emplace_back([&, s, part] {
                    upload(sessions[s], part, parts, 100 * seed + 10 * part + static_cast<unsigned>(s), breaks, policy,
                           answers[s * parts + part]);
                });
        for (std::thread& uploader : uploaders) uploader.join();
        for (std::size_t i = 0; i < answers.size(); ++i) {
            Answers told = answers[i];
            for (std::string& answer : told)
                if (answer.front() == '-') answer.erase(0, 1);
            Answers each;
            for (int index = 0; index < 12; ++index) each.push_back(std::to_string(index));
            EXPECT_EQ(told, each) << "seed " << seed << ", stream " << i;
            if (breaks == 0) {
                EXPECT_EQ(answers[i], answers[i / parts * parts]) << "a frame is dropped for all parts or for none";
            }
            if (breaks == 0 && policy == UploadPolicy::every_frame) {
                EXPECT_EQ(answers[i], each) << "seed " << seed;
            }
        }
        for (const CheckedSession& checked : sessions) {
            EXPECT_EQ(checked.mixed, 0) << "seed " << seed;
            EXPECT_FALSE(checked.session->state().uploading);
            checked.end();
        }
        EXPECT_EQ(bytes->bytes(), 0U) << "seed " << seed;
        EXPECT_EQ(bytes->waiting(), 0U) << "seed " << seed;
    }
}

}  // namespace
}  // namespace meniscus::server::test
