#include "rpc/list_recordings_handler.hpp"

#include <algorithm>
#include <cstddef>

namespace meniscus::server {

namespace {

/// Some 500 kB: far below what clients take as one message.
constexpr int most = 4096;

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
    return message;
}

}  // namespace

v1::ListRecordingsResponse list_recordings(RecordingCatalog& catalog, const Caller& caller) {
    v1::ListRecordingsResponse response;
    auto& recordings = *response.mutable_recordings();
    for (const auto& [name, entry] : catalog.list())
        if (Authorizer::may_see(caller, entry.index.begin().owner()))
            recordings.Add(recording_message(name, entry.index));
    std::stable_sort(recordings.begin(), recordings.end(),
                     [](const v1::Recording& a, const v1::Recording& b) { return a.started_at() > b.started_at(); });
    if (recordings.size() > most) recordings.DeleteSubrange(most, recordings.size() - most);
    return response;
}

}  // namespace meniscus::server
