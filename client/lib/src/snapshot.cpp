#include "snapshot.hpp"

#include <utility>

#include "conversion/codec_conversion.hpp"
#include "error_mapping.hpp"
#include "receiving/frame_receiver.hpp"

namespace meniscus::client {

std::optional<ReceivedFrame> take_snapshot(const Connection& connection, const std::string& session_id,
                                           const SnapshotOptions& options) {
    grpc::ClientContext context;
    connection.add_metadata(context, session_id);
    v1::SnapshotRequest request;
    request.set_session_id(session_id);
    request.set_normal_bits(static_cast<std::uint32_t>(options.normal_bits));
    if (options.position_bits) request.set_position_bits(static_cast<std::uint32_t>(*options.position_bits));
    request.set_max_level(static_cast<std::uint32_t>(options.max_level));
    conversion::add_known_codecs(*request.mutable_codecs());
    const auto call = connection.surfaces->Snapshot(&context, request);
    FrameReceiver receiver(true, true);  // as a watcher's: of another level than the statistics
    std::optional<ReceivedFrame> frame;
    v1::WatchResponse response;
    try {
        while (call->Read(&response))
            if (auto whole = receiver.take(response)) frame = std::move(whole);
    } catch (...) {
        context.TryCancel();
        while (call->Read(&response)) {
        }
        call->Finish();
        throw;
    }
    require_ok(call->Finish(), connection.address);
    receiver.end_of_stream();
    return frame;
}

}  // namespace meniscus::client
