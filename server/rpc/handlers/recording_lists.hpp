// RecordingService.ListRecordings: the calls that wait at a time share one look into the folder.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "recording/recording_reads.hpp"
#include "rpc/calls/unary_call.hpp"

namespace meniscus::server {

/// Thread-safe. Callers that may see the same share an answer, too: a call costs hardly more than its sending.
class RecordingLists : public std::enable_shared_from_this<RecordingLists> {
public:
    /// Answers with what is in the folder at a moment after this, or refuses once the server goes down.
    void answer(RecordingReads& reads, UnaryCall& call);

private:
    /// On the thread that reads.
    void answer_waiting(const RecordingReads& reads, RecordingCatalog& catalog);

    std::mutex mutex_;
    std::vector<UnaryCall*> waiting_;
};

}  // namespace meniscus::server
