#include "recording/recording_tidying.hpp"

#include <exception>

#include "process/log.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

RecordingTidying::RecordingTidying(RecordingReads& reads, const RecordingRetention& retention,
                                   std::chrono::milliseconds interval)
    : reads_(reads), retention_(retention) {
    if (retention.keeps_all()) return;
    look();
    timer_.every(interval, [this] { look(); });
}

void RecordingTidying::look() {
    if (waits_->exchange(true)) return;
    reads_.post_scan([&reads = reads_, retention = retention_, waits = waits_](RecordingCatalog& catalog) {
        *waits = false;
        try {
            catalog.tidy(retention, std::filesystem::file_time_type::clock::now(), [&] { reads.require_going_on(); });
        } catch (const Refusal&) {
            // The server goes down.
        } catch (const std::exception& error) {
            log_error({}, "old recordings are not deleted: {}", error.what());
        }
    });
}

}  // namespace meniscus::server
