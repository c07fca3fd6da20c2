#include "rpc/handlers/recording_lists.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "rpc/handlers/list_recordings_handler.hpp"
#include "rpc/messages/wire_bytes.hpp"

namespace meniscus::server {

namespace {

struct Answer {
    Caller caller;
    grpc::ByteBuffer bytes;
};

const grpc::ByteBuffer& answer_for(const Caller& caller, RecordingCatalog& catalog, std::vector<Answer>& answers) {
    const auto made = std::find_if(answers.begin(), answers.end(), [&](const Answer& answer) {
        return Authorizer::see_the_same(answer.caller, caller);
    });
    if (made != answers.end()) return made->bytes;
    answers.push_back({.caller = caller, .bytes = serialized(list_recordings(catalog.known(), caller))});
    return answers.back().bytes;
}

}  // namespace

void RecordingLists::answer(RecordingReads& reads, UnaryCall& call) {
    reads.require_going_on();
    {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(&call);
        if (waiting_.size() > 1) return;
    }
    reads.post_scan(
        [self = shared_from_this(), &reads](RecordingCatalog& catalog) { self->answer_waiting(reads, catalog); });
}

void RecordingLists::answer_waiting(const RecordingReads& reads, RecordingCatalog& catalog) {
    std::vector<UnaryCall*> calls;
    {
        const std::lock_guard lock(mutex_);
        calls.swap(waiting_);
    }
    std::erase_if(calls, [](UnaryCall* call) { return call->finish_if_canceled(); });
    if (calls.empty()) return;
    std::exception_ptr refusal;
    try {
        catalog.scan([&] { reads.require_going_on(); });
    } catch (...) {
        refusal = std::current_exception();
    }
    std::vector<Answer> answers;
    for (UnaryCall* call : calls) {
        try {
            if (refusal) std::rethrow_exception(refusal);
            reads.require_going_on();
            call->answer(answer_for(call->caller(), catalog, answers));
        } catch (...) {
            call->refuse(std::current_exception());
        }
    }
}

}  // namespace meniscus::server
