#include "rpc/handlers/list_recordings_handler.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "meniscus/error.hpp"
#include "rpc/messages/session_description.hpp"

namespace meniscus::server {

namespace {

/// Some 500 kB, and 2 MB with the longest names: below what clients take as one message.
constexpr std::size_t most = 4096;

/// The recording's description; empty if it is not valid: another program may have written the file.
v1::SessionDescription description_of(const v1::RecordingBegin& begin) {
    try {
        return checked_description(begin.description());
    } catch (const InvalidInput&) {
        return {};
    }
}

v1::Recording recording_message(const RecordingName& name, const RecordingIndex& index) {
    v1::Recording message;
    message.set_session_id(name.session_id);
    message.set_number(name.number);
    message.set_started_at(index.begin().started_at());
    message.set_frames(index.meshes().size());
    if (!index.meshes().empty()) {
        message.set_first_frame_index(index.meshes().front().frame_index);
        message.set_last_frame_index(index.meshes().back().frame_index);
    }
    message.set_bytes(index.bytes());
    message.set_being_written(index.being_written());
    message.set_damaged(index.damaged());
    message.set_owner(index.begin().owner());
    *message.mutable_description() = description_of(index.begin());
    return message;
}

}  // namespace

v1::ListRecordingsResponse list_recordings(const RecordingCatalog::Entries& recordings, const Caller& caller) {
    std::vector<const RecordingCatalog::Entries::value_type*> seen;
    for (const auto& recording : recordings)
        if (Authorizer::may_see(caller, recording.second.index.begin().owner())) seen.push_back(&recording);
    const auto started_at = [](const auto* recording) { return recording->second.index.begin().started_at(); };
    std::stable_sort(seen.begin(), seen.end(),
                     [&](const auto* a, const auto* b) { return started_at(a) > started_at(b); });
    v1::ListRecordingsResponse response;
    for (const auto* recording : std::span(seen).first(std::min(seen.size(), most)))
        *response.add_recordings() = recording_message(recording->first, recording->second.index);
    return response;
}

}  // namespace meniscus::server
