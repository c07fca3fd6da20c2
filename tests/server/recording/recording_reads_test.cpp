// The one thread that reads recordings: what looks through the whole folder leaves time to the readers.
#include "recording/recording_reads.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>
#include <utility>
#include <vector>

#include "sessions/limits/refusal.hpp"
#include "test_folder.hpp"

namespace meniscus::server {
namespace {

using Clock = std::chrono::steady_clock;

struct Scan {
    Clock::time_point begun, ended;
};

/// Posts scans that take some time each and begin to wait while the first is under way.
class Scans {
public:
    Scans(RecordingReads& reads, std::size_t count) : scans_(count) {
        for (std::size_t i = 0; i < count; ++i)
            reads.post_scan([this, i](RecordingCatalog&) {
                scans_[i].begun = Clock::now();
                if (i == 0) all_are_posted_.get_future().wait();
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                scans_[i].ended = Clock::now();
                if (i + 1 == scans_.size()) done_.set_value();
            });
        all_are_posted_.set_value();
    }
    const std::vector<Scan>& ended() {
        EXPECT_EQ(done_.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
        return scans_;
    }

private:
    std::vector<Scan> scans_;
    std::promise<void> all_are_posted_, done_;
};

TEST(RecordingReads, ScansThatWaitTogetherLeaveHalfOfTheTimeToReaders) {
    const test::TestFolder folder;
    RecordingReads reads(folder / "", 0, {});
    Scans waiting(reads, 4);
    const std::vector<Scan>& scans = waiting.ended();
    for (std::size_t i = 1; i < scans.size(); ++i)
        EXPECT_GE(scans[i].begun - scans[i - 1].ended, scans[i - 1].ended - scans[i - 1].begun) << i;
}

TEST(RecordingReads, ScansThatWaitWhereTheServerEndsAllFindOut) {
    const test::TestFolder folder;
    RecordingReads reads(folder / "", 0, {});
    std::promise<int> refused;
    std::promise<void> ending;
    int count = 0;
    reads.post_scan([&](RecordingCatalog&) { ending.get_future().wait(); });
    for (int i = 0; i < 3; ++i)
        reads.post_scan([&](RecordingCatalog&) {
            try {
                reads.require_going_on();
            } catch (const Refusal&) {
                ++count;
            }
            if (count == 3) refused.set_value(count);
        });
    reads.end();
    ending.set_value();
    EXPECT_EQ(refused.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
}

}  // namespace
}  // namespace meniscus::server
