// The way of frames to the disk.
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <regex>
#include <semaphore>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "files/recording_format.hpp"
#include "meniscus/error.hpp"
#include "process/call_log.hpp"
#include "process/log.hpp"
#include "recording/delete_recording.hpp"
#include "recording/free_number.hpp"
#include "recording/session_recording.hpp"
#include "recording/write_queue.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

const std::string session_id = "00000000-0000-4000-8000-000000000001";

class RecordingWriterTest : public testing::Test {
protected:
    RecordingWriterTest() { std::filesystem::create_directory(directory_); }
    ~RecordingWriterTest() override { std::filesystem::remove_all(directory_); }

    RecordingOptions options() const { return {.directory = directory_}; }
    std::filesystem::path file(int number) const {
        return directory_ / session_id / ("00000" + std::to_string(number) + ".recording");
    }
    /// Bytes of all recordings.
    std::uint64_t bytes() const {
        std::uint64_t sum = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(directory_))
            if (entry.path().extension() == ".recording") sum += entry.file_size();
        return sum;
    }

    const std::filesystem::path directory_ =
        std::filesystem::temp_directory_path() / ("meniscus-recordings-" + std::to_string(::getpid()));
};

InputFrame frame(std::uint64_t index, std::size_t particles = 4) {
    InputFrame frame(nullptr);
    frame.allocate(12 * particles);
    std::fill(frame.bytes.begin(), frame.bytes.end(), std::byte{0});
    frame.index = index;
    frame.particle_count = particles;
    frame.received_at = std::chrono::steady_clock::now();
    return frame;
}

/// The lines that are logged during the work.
std::string log_of(const std::function<void()>& work) {
    std::ostringstream log;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
    use_log_format(LogFormat::text);
    work();
    spdlog::set_default_logger(before);
    return log.str();
}

std::shared_ptr<const EncodedFrame> mesh(std::uint64_t index) {
    auto encoded = std::make_shared<EncodedFrame>();
    encoded->index = index;
    encoded->begin = encoded->end = std::make_shared<const std::string>("mesh");
    return encoded;
}

TEST(WriteQueue, TakesNoMoreThanItsLimitAtATime) {
    WriteQueue<int> queue(100);
    EXPECT_TRUE(queue.reserve("a", 60));
    EXPECT_FALSE(queue.reserve("b", 41));
    EXPECT_TRUE(queue.reserve("b", 30));
    queue.cancel("b", 30);
    queue.put(1, "a", 60);
    EXPECT_FALSE(queue.reserve("b", 41));
    EXPECT_EQ(queue.take(), 1);
    EXPECT_FALSE(queue.reserve("b", 41)) << "what is being written is in memory still";
    queue.close();
    EXPECT_EQ(queue.take(), std::nullopt);
    EXPECT_TRUE(queue.reserve("b", 75));
}

TEST(WriteQueue, LeavesRoomForOthersHoweverManyFillIt) {
    WriteQueue<int> queue(100'000);
    for (const std::string name : {"a", "b", "c", "d", "e", "f", "g"}) {
        int taken = 0;
        while (queue.reserve(name, 1)) ++taken;
        EXPECT_GT(taken, 0) << name;
        EXPECT_LE(taken, 75'000) << name;
    }
    EXPECT_TRUE(queue.reserve("h", 1));
    queue.cancel("a", 70'000);
    EXPECT_TRUE(queue.reserve("b", 30'000)) << "room comes back";
}

TEST(WriteQueue, TakesALargerFrameAlone) {
    WriteQueue<int> queue(100);
    EXPECT_TRUE(queue.reserve("a", 1000));
    EXPECT_FALSE(queue.reserve("b", 1));
}

TEST(WriteQueue, GivesWhatWaitsAfterItsEnd) {
    WriteQueue<int> queue(100);
    for (const int i : {1, 2}) {
        ASSERT_TRUE(queue.reserve("a", 1));
        queue.put(i, "a", 1);
    }
    queue.close();
    EXPECT_EQ(queue.take(), 1);
    EXPECT_EQ(queue.take(), 2);
    EXPECT_EQ(queue.take(), std::nullopt);
}

TEST(WriteQueue, NamesWhatIsLeftAtItsDeadline) {
    WriteQueue<int> queue(100);
    for (const int i : {1, 2, 3}) {
        ASSERT_TRUE(queue.reserve("a", 10));
        queue.put(i, "a", 10);
    }
    queue.close();
    EXPECT_EQ(queue.take(), 1);
    std::vector<int> left;
    queue.finish(std::chrono::steady_clock::now(), [&](int value) { left.push_back(value); });
    EXPECT_EQ(left, (std::vector<int>{2, 3}));
    EXPECT_EQ(queue.take(), std::nullopt);
}

TEST(FreeNumber, IsTheOneAfterThoseThatAreTaken) {
    for (const std::uint32_t taken : {0U, 1U, 2U, 3U, 4U, 7U, 8U, 9U, 1000U, 1'000'000U}) {
        int questions = 0;
        EXPECT_EQ(free_number([&](std::uint32_t number) { return ++questions, number <= taken; }), taken + 1);
        EXPECT_LE(questions, 45);
    }
}

TEST(FreeNumber, IsFreeWhereNumbersAreMissing) {
    const std::set<std::uint32_t> taken{1, 2, 4, 5, 8, 11};
    EXPECT_FALSE(taken.contains(free_number([&](std::uint32_t number) { return taken.contains(number); })));
}

TEST_F(RecordingWriterTest, WritesWhatWaitsBeforeItEnds) {
    {
        RecordingWriter writer(options());
        SessionRecording recording(writer, session_id, settings());
        for (std::uint64_t i = 0; i < 100; ++i) {
            recording.reconstructed(frame(i));
            recording.encoded(mesh(i));
        }
    }
    EXPECT_GT(bytes(), 100U * 48U);
    EXPECT_FALSE(std::filesystem::exists(file(2)));
}

TEST_F(RecordingWriterTest, BeginsAnotherFileWhereIndicesDoNotRise) {
    {
        RecordingWriter writer(options());
        SessionRecording recording(writer, session_id, settings());
        for (const std::uint64_t i : {3, 4, 4, 9, 0}) recording.reconstructed(frame(i));
    }
    EXPECT_TRUE(std::filesystem::exists(file(3)));
    EXPECT_FALSE(std::filesystem::exists(file(4)));
}

TEST_F(RecordingWriterTest, KeepsWhatAnEarlierServerRecorded) {
    for (int server = 0; server < 2; ++server) {
        RecordingWriter writer(options());
        SessionRecording(writer, session_id, settings()).reconstructed(frame(0));
    }
    EXPECT_EQ(std::filesystem::file_size(file(1)), std::filesystem::file_size(file(2)));
}

TEST_F(RecordingWriterTest, GivesNoRecordingTheNumberOfOneThatWasDeleted) {
    const auto next = [&] { return RecordingFile(directory_, session_id).number(); };
    const auto remove = [&](std::uint32_t number) {
        delete_recording(directory_ / session_id / recording_file_name(number),
                         {.session_id = session_id, .number = number}, 0, 0, "a test");
    };
    log_of([&] {
        for (const std::uint32_t number : {1U, 2U, 3U}) EXPECT_EQ(next(), number);
        remove(2);
        EXPECT_EQ(next(), 4U) << "one from among them had gone";
        remove(4);
        EXPECT_EQ(next(), 5U) << "the newest had gone";
        for (const std::uint32_t number : {5U, 1U, 3U}) remove(number);
        EXPECT_FALSE(std::filesystem::exists(directory_ / session_id));
        EXPECT_EQ(next(), 6U) << "all had gone, and the folder with them";
        EXPECT_EQ(RecordingFile(directory_, "00000000-0000-4000-8000-000000000002").number(), 1U)
            << "of another session";
    });
}

TEST_F(RecordingWriterTest, TellsOfADeletionWhateverElseIsLogged) {
    const std::string log = log_of([&] {
        for (int i = 0; i < 4000; ++i) call_log.write({}, "more than what is let through at a time");
        const RecordingFile file(directory_, session_id);
        delete_recording(file.path(), {.session_id = session_id, .number = file.number()}, 0, 0, "a test");
    });
    EXPECT_NE(log.find("its recording 1 is deleted"), std::string::npos);
}

TEST_F(RecordingWriterTest, IsTheOperatorsAlone) {
    {
        RecordingWriter writer({.directory = directory_ / "made"});
        SessionRecording(writer, session_id, settings()).reconstructed(frame(0));
    }
    using std::filesystem::perms;
    const auto mode = [&](const std::filesystem::path& path) { return std::filesystem::status(path).permissions(); };
    EXPECT_EQ(mode(directory_ / "made"), perms::owner_all);
    EXPECT_EQ(mode(directory_ / "made" / session_id), perms::owner_all);
    EXPECT_EQ(mode(directory_ / "made" / session_id / "000001.recording"), perms::owner_read | perms::owner_write);
}

TEST_F(RecordingWriterTest, NeverPassesItsLimitAndDeletesNothing) {
    RecordingOptions limited = options();
    std::uint64_t first = 0;
    {
        RecordingWriter writer(limited);
        SessionRecording(writer, session_id, settings()).reconstructed(frame(0));
    }
    first = bytes();
    limited.limit = 2 * first + first / 2;  // what is there, as much again, and too little for a third
    RecordingCounters counters;
    {
        RecordingWriter writer(limited);
        SessionRecording recording(writer, session_id, settings());
        recording.reconstructed(frame(0));
        for (std::uint64_t i = 1; i < 20; ++i) recording.reconstructed(frame(i));
        SessionRecording other(writer, "00000000-0000-4000-8000-000000000002", settings());
        other.reconstructed(frame(0, 64));
        while (writer.counters().stopped < 2) {
        }
        counters = writer.counters();
    }
    EXPECT_LE(bytes(), limited.limit);
    EXPECT_GE(bytes(), 2 * first);
    EXPECT_EQ(std::filesystem::file_size(file(1)), first);
    EXPECT_EQ(counters.bytes, bytes() - first);
    EXPECT_EQ(counters.frames_left_out, 0U);
}

TEST_F(RecordingWriterTest, FindsTheRoomThatDeletedRecordingsLeave) {
    RecordingOptions limited = options();
    limited.limit = 400;
    RecordingWriter writer(limited);
    SessionRecording full(writer, session_id, settings());
    for (std::uint64_t i = 0; i < 10; ++i) full.reconstructed(frame(i));
    while (writer.counters().stopped < 1) {
    }
    const std::uint64_t frames = writer.counters().frames;
    std::filesystem::remove(file(1));
    SessionRecording next(writer, "00000000-0000-4000-8000-000000000002", settings());
    next.reconstructed(frame(0));
    while (writer.counters().frames == frames && writer.counters().stopped < 2) {
    }
    EXPECT_EQ(writer.counters().stopped, 1U);
}

TEST_F(RecordingWriterTest, LeavesOutFramesThatTheDiskIsTooSlowFor) {
    RecordingOptions narrow = options();
    narrow.waiting_limit = 1;  // the disk is slower than a loop over frames of a megabyte
    RecordingCounters counters;
    constexpr std::uint64_t frames = 50;
    {
        RecordingWriter writer(narrow);
        SessionRecording recording(writer, session_id, settings());
        InputFrame large = frame(0, 100'000);
        for (; large.index < frames; ++large.index) recording.reconstructed(large);
        do counters = writer.counters();
        while (counters.frames + counters.frames_left_out < frames);
    }
    EXPECT_GT(counters.frames, 0U);
    EXPECT_GT(counters.frames_left_out, 0U);
    EXPECT_EQ(counters.stopped, 0U);
}

TEST_F(RecordingWriterTest, LeavesOutFramesWithoutParticlesThatTheDiskIsTooSlowFor) {
    RecordingOptions narrow = options();
    narrow.waiting_limit = 1;
    RecordingWriter writer(narrow);
    SessionRecording recording(writer, session_id, settings());
    const InputFrame empty = frame(0, 0);
    for (int i = 0; i < 2000; ++i) recording.reconstructed(empty);  // a file each
    EXPECT_GT(writer.counters().frames_left_out, 0U);
}

TEST_F(RecordingWriterTest, SaysWhatItsEndLeavesOut) {
    constexpr std::uint64_t frames = 3000;
    const std::string log = log_of([&] {
        RecordingWriter writer(options());
        SessionRecording recording(writer, session_id, settings());
        const InputFrame empty = frame(0, 0);
        for (std::uint64_t i = 0; i < frames; ++i) recording.reconstructed(empty);  // a file each
        writer.finish_by(std::chrono::steady_clock::now());
    });
    // The folder comes with the first file.
    const auto folder = directory_ / session_id;
    const auto written =
        std::filesystem::exists(folder)
            ? static_cast<std::uint64_t>(std::distance(std::filesystem::directory_iterator(folder), {}))
            : 0;
    EXPECT_LT(written, frames);
    EXPECT_NE(log.find("came before the disk: " + std::to_string(frames - written) +
                       " particles or meshes of frames are left out at the ends of the recordings of 1 "
                       "sessions: " +
                       session_id),
              std::string::npos)
        << written << " written";
}

TEST_F(RecordingWriterTest, DeletesARecordingOfTooFewFramesWhenItIsClosed) {
    RecordingOptions tidy = options();
    tidy.retention.min_frames = 2;
    RecordingWriter writer(tidy);
    const auto record = [](SessionRecording& recording, std::uint64_t index) {
        recording.reconstructed(frame(index));
        recording.encoded(mesh(index));
    };
    {
        SessionRecording recording(writer, session_id, settings());
        record(recording, 5);
        record(recording, 3);  // ends the first
        record(recording, 4);
    }
    const auto files = [&] { return std::distance(std::filesystem::directory_iterator(directory_ / session_id), {}); };
    while (writer.counters().frames < 3 || files() != 1) {
    }
    EXPECT_GT(bytes(), 2U * 48U) << "two frames are enough";
    {
        SessionRecording other(writer, "00000000-0000-4000-8000-000000000002", settings());
        record(other, 0);
    }
    while (writer.counters().frames < 4 ||
           std::filesystem::exists(directory_ / "00000000-0000-4000-8000-000000000002")) {
    }
    EXPECT_EQ(files(), 1);
}

TEST_F(RecordingWriterTest, DeletesShortRecordingsThatItsEndClosesWithTheirFolders) {
    RecordingOptions tidy = options();
    tidy.retention.min_frames = 2;
    const std::string log = log_of([&] {
        RecordingWriter writer(tidy);
        SessionRecording recording(writer, session_id, settings());
        recording.reconstructed(frame(0));
        recording.encoded(mesh(0));
        recording.reconstructed(frame(1));  // a frame without a mesh is none
    });
    EXPECT_FALSE(std::filesystem::exists(directory_ / session_id));
    EXPECT_TRUE(
        std::regex_search(log, std::regex("session " + session_id +
                                          ": its recording 1 is deleted: 1 frames, [0-9]+ bytes; they are fewer "
                                          "than --record-min-frames 2\n")))
        << log;
}

TEST_F(RecordingWriterTest, DeletesShortRecordingsThoughItsEndComesBeforeTheDisk) {
    RecordingOptions tidy = options();
    tidy.retention.min_frames = 1;
    {
        RecordingWriter writer(tidy);
        SessionRecording recording(writer, session_id, settings());
        const InputFrame empty = frame(0, 0);
        for (int i = 0; i < 1000; ++i) recording.reconstructed(empty);  // a file each
        writer.finish_by(std::chrono::steady_clock::now());
    }
    EXPECT_FALSE(std::filesystem::exists(directory_ / session_id));
}

TEST_F(RecordingWriterTest, BeginsARecordingThoughTheFolderGoesWithTheOneBefore) {
    constexpr int recordings = 300;
    log_of([&] {
        auto before = std::make_unique<RecordingFile>(directory_, session_id);
        std::binary_semaphore given(0);
        std::binary_semaphore gone(0);
        std::thread deletes([&] {
            for (int i = 0; i < recordings; ++i) {
                given.acquire();
                delete_recording(before->path(), {.session_id = session_id, .number = before->number()}, 0, 0,
                                 "a test");
                gone.release();
            }
        });
        for (int i = 0; i < recordings; ++i) {
            std::unique_ptr<RecordingFile> next;
            given.release();
            EXPECT_NO_THROW(next = std::make_unique<RecordingFile>(directory_, session_id));
            gone.acquire();
            before = next ? std::move(next) : std::make_unique<RecordingFile>(directory_, session_id);
        }
        deletes.join();
    });
}

TEST_F(RecordingWriterTest, DoesNotTryForEverToBeginARecording) {
    std::filesystem::create_symlink(directory_ / "nowhere", directory_ / session_id);
    EXPECT_THROW(RecordingFile(directory_, session_id), std::runtime_error);
}

TEST_F(RecordingWriterTest, AFileThatCannotBeCreatedStopsThatSessionsRecordingAlone) {
    std::ofstream(directory_ / session_id) << "in the way";
    RecordingWriter writer(options());
    SessionRecording blocked(writer, session_id, settings());
    SessionRecording other(writer, "00000000-0000-4000-8000-000000000002", settings());
    blocked.reconstructed(frame(0));
    other.reconstructed(frame(0));
    while (writer.counters().frames < 1) {
    }
    EXPECT_EQ(writer.counters().stopped, 1U);
    EXPECT_EQ(writer.counters().frames, 1U);
}

TEST_F(RecordingWriterTest, RefusesAFolderThatAnotherRecordsIn) {
    {
        const RecordingWriter writer(options());
        try {
            const RecordingWriter another(options());
            FAIL() << "two record in one folder";
        } catch (const FolderInUse& error) {
            const std::string expected = "--record " + directory_.string() + ": another meniscusd, process " +
                                         std::to_string(::getpid()) +
                                         ", records there: give each server a folder of its own";
            EXPECT_EQ(error.what(), expected);
        }
    }
    EXPECT_NO_THROW(RecordingWriter{options()});
}

TEST_F(RecordingWriterTest, RefusesAFolderThatCannotBe) {
    std::ofstream(directory_ / "file") << "no folder";
    EXPECT_THROW(RecordingWriter({.directory = directory_ / "file"}), InvalidInput);
    EXPECT_THROW(RecordingWriter({.directory = directory_ / "missing" / "folder"}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::server::test
