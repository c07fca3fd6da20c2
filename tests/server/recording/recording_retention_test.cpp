// Which recordings a look into the folder deletes, by a clock of the test's.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "recording/recording_catalog.hpp"
#include "recording/session_recording.hpp"
#include "sessions/limits/refusal.hpp"
#include "test_folder.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;

const std::string first_session = "00000000-0000-4000-8000-000000000001";
const std::string second_session = "00000000-0000-4000-8000-000000000002";

bool everybody(const std::string& /*owner*/) {
    return true;
}

class RetainedRecordings : public testing::Test {
protected:
    /// Records this number of frames; the recording is closed once the writer has ended.
    static void record(RecordingWriter& writer, const std::string& session, std::uint64_t frames) {
        const auto recording = std::make_shared<SessionRecording>(writer, session, settings());
        for (std::uint64_t i = 0; i < frames; ++i) {
            InputFrame input(nullptr);
            input.index = i;
            recording->reconstructed(input);
            auto encoded = std::make_shared<EncodedFrame>();
            encoded->index = i;
            encoded->begin = encoded->end = std::make_shared<const std::string>("mesh");
            recording->encoded(encoded);
        }
    }
    void record(const std::string& session, std::uint64_t frames) {
        RecordingWriter writer({.directory = folder_ / "."});
        record(writer, session, frames);
    }
    std::filesystem::path file(const std::string& session) const { return folder_ / (session + "/000001.recording"); }
    bool is_there(const std::string& session) const { return std::filesystem::exists(file(session)); }
    void look(const RecordingRetention& retention, std::chrono::seconds after = {}) {
        catalog_.tidy(retention, written_ + after, [] {});
    }
    /// From here on the files' age is counted.
    void set_times() {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "."))
            if (entry.is_regular_file()) std::filesystem::last_write_time(entry.path(), written_);
    }

    const TestFolder folder_;
    const std::filesystem::file_time_type written_ = std::filesystem::file_time_type::clock::now() - hours(24);
    RecordingCatalog catalog_{folder_ / "."};
};

TEST_F(RetainedRecordings, GoWithTheirAge) {
    record(first_session, 3);
    record(second_session, 3);
    set_times();
    std::filesystem::last_write_time(file(second_session), written_ + minutes(30));
    look({.max_age = hours(1)}, minutes(59));
    EXPECT_TRUE(is_there(first_session) && is_there(second_session));
    look({.max_age = hours(1)}, minutes(60));
    EXPECT_FALSE(std::filesystem::exists(folder_ / first_session));
    EXPECT_TRUE(is_there(second_session));
    EXPECT_THROW(catalog_.open({.session_id = first_session, .number = 1}, everybody), Refusal);
    look({.max_age = hours(1)}, minutes(90));
    EXPECT_FALSE(is_there(second_session));
}

TEST_F(RetainedRecordings, GoIfAnEarlierServerLeftThemWithTooFewFrames) {
    record(first_session, 2);
    record(second_session, 3);
    look({.min_frames = 3});
    EXPECT_FALSE(std::filesystem::exists(folder_ / first_session));
    EXPECT_TRUE(is_there(second_session));
}

TEST_F(RetainedRecordings, StayWhereNothingIsSaid) {
    record(first_session, 1);
    look({}, hours(100'000));
    EXPECT_TRUE(is_there(first_session));
}

TEST_F(RetainedRecordings, StayWhileTheyAreBeingWritten) {
    RecordingWriter writer({.directory = folder_ / "."});
    auto recording = std::make_shared<SessionRecording>(writer, first_session, settings());
    InputFrame input(nullptr);
    recording->reconstructed(input);
    while (writer.counters().frames < 1) {
    }
    look({.min_frames = 2, .max_age = hours(1)}, hours(48));
    EXPECT_TRUE(is_there(first_session));
    EXPECT_THROW(catalog_.remove({.session_id = first_session, .number = 1}, everybody, "of a test"), Refusal);
    recording.reset();
    while (is_there(first_session)) look({.min_frames = 2});
}

TEST_F(RetainedRecordings, StayWhileTheyAreBeingRead) {
    record(first_session, 1);
    set_times();
    auto reader = catalog_.open({.session_id = first_session, .number = 1}, everybody).file;
    look({.min_frames = 2, .max_age = hours(1)}, hours(2));
    EXPECT_TRUE(is_there(first_session));
    EXPECT_THROW(catalog_.remove({.session_id = first_session, .number = 1}, everybody, "of a test"), Refusal);
    reader.reset();
    look({.min_frames = 2, .max_age = hours(1)}, hours(2));
    EXPECT_FALSE(is_there(first_session));
}

TEST_F(RetainedRecordings, StayIfTheyAreDamagedUntilTheyAreOld) {
    record(first_session, 1);
    std::ofstream(file(first_session), std::ios::binary | std::ios::app) << "\x05nonsense";
    set_times();
    look({.min_frames = 2});
    EXPECT_TRUE(is_there(first_session)) << "nobody knows how many frames it had";
    look({.max_age = hours(1)}, hours(2));
    EXPECT_FALSE(is_there(first_session));
}

TEST_F(RetainedRecordings, AreNoneOfOtherFiles) {
    record(first_session, 1);
    std::filesystem::create_directory(folder_ / second_session);
    std::filesystem::copy_file(file(first_session), file(second_session));  // of another session
    const std::string stranger = folder_ / (second_session + "/000002.recording");
    const std::string text = folder_ / (first_session + "/notes.txt");
    std::ofstream(stranger) << "no recording";
    std::ofstream(text) << "text";
    set_times();
    look({.min_frames = 100, .max_age = hours(1)}, hours(2));
    EXPECT_FALSE(is_there(first_session));
    EXPECT_TRUE(std::filesystem::exists(text));
    EXPECT_TRUE(is_there(second_session));
    EXPECT_TRUE(std::filesystem::exists(stranger));
}

TEST_F(RetainedRecordings, EndTheLookWhereTheServerDoes) {
    record(first_session, 1);
    EXPECT_THROW(catalog_.tidy({.min_frames = 2}, written_, [] { throw shutting_down(); }), Refusal);
    EXPECT_TRUE(is_there(first_session));
}

}  // namespace
}  // namespace meniscus::server::test
