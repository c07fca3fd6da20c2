#include "snapshot.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "codec_order.hpp"
#include "connection/deadline.hpp"
#include "conversion/attribute_conversion.hpp"
#include "error_mapping.hpp"
#include "receiving/frame_receiver.hpp"
#include "unary_call.hpp"

namespace meniscus::client {

namespace {

/// For the next part of a snapshot that the server has accepted: it gives up a mesh that does not come after 20 s, and
/// says so.
constexpr std::chrono::seconds part_time{30};

/// Cancels a call in which nothing comes for the limit: gRPC's blocking reads know no such limit, and a deadline would
/// end large meshes on slow ways.
class SilenceLimit {
public:
    SilenceLimit(grpc::ClientContext& context, std::chrono::milliseconds limit) : context_(context) {
        begin(limit);
        thread_ = std::thread([this] { watch(); });
    }
    ~SilenceLimit() {
        {
            const std::lock_guard lock(mutex_);
            call_is_over_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    SilenceLimit(const SilenceLimit&) = delete;
    SilenceLimit& operator=(const SilenceLimit&) = delete;

    /// Something has come: the limit counts anew.
    void begin(std::chrono::milliseconds limit) {
        {
            const std::lock_guard lock(mutex_);
            if (was_exceeded_) return;
            limit_ = limit;
            until_ = deadline_after<std::chrono::steady_clock>(limit);
        }
        changed_.notify_all();
    }
    /// The status of the call that has ended, or the one for a call that is not answered.
    grpc::Status of(grpc::Status status) {
        const std::lock_guard lock(mutex_);
        return was_exceeded_ ? not_answered(limit_) : std::move(status);
    }

private:
    void watch() {
        std::unique_lock lock(mutex_);
        while (!call_is_over_) {
            if (std::chrono::steady_clock::now() >= until_) {
                was_exceeded_ = true;
                context_.TryCancel();
                return;
            }
            changed_.wait_until(lock, until_);
        }
    }

    grpc::ClientContext& context_;
    std::mutex mutex_;  ///< for what follows
    std::condition_variable changed_;
    std::chrono::milliseconds limit_{};
    std::chrono::steady_clock::time_point until_;
    bool was_exceeded_ = false;
    bool call_is_over_ = false;
    std::thread thread_;
};

}  // namespace

std::optional<ReceivedFrame> take_snapshot(const Connection& connection, const std::string& session_id,
                                           const SnapshotOptions& options) {
    grpc::ClientContext context;
    connection.add_metadata(context, session_id);
    v1::SnapshotRequest request;
    request.set_session_id(session_id);
    request.set_normal_bits(static_cast<std::uint32_t>(asked_normal_bits(options.normals_by, options.normal_bits)));
    *request.mutable_attributes() = conversion::to_wire(std::span(options.attributes));
    if (options.position_bits) request.set_position_bits(static_cast<std::uint32_t>(*options.position_bits));
    request.set_max_level(static_cast<std::uint32_t>(options.max_level));
    SilenceLimit silence(context, connection.timeout);
    const CancelOnStop cancel_on_stop(context, options.stop);
    *request.mutable_codecs() = codec_order(connection, options.codec, options.stop);
    const auto call = connection.surfaces->Snapshot(&context, request);
    call->WaitForInitialMetadata();
    silence.begin(part_time);
    FrameReceiver receiver(true, true);  // as a watcher's: of another level than the statistics
    std::optional<ReceivedFrame> frame;
    v1::WatchResponse response;
    try {
        while (call->Read(&response)) {
            silence.begin(part_time);
            if (auto whole = receiver.take(response)) frame = std::move(whole);
        }
    } catch (...) {
        context.TryCancel();
        while (call->Read(&response)) {
        }
        call->Finish();
        throw;
    }
    require_ok(silence.of(call->Finish()), connection.address);
    receiver.end_of_stream();
    if (frame) frame->normals_by = options.normals_by;
    return frame;
}

}  // namespace meniscus::client
