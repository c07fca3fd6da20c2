// One simulator's settings, buffers, latest mesh and watchers.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/settings.hpp"
#include "sessions/intake/frame_queue.hpp"
#include "sessions/intake/frame_stop.hpp"
#include "sessions/intake/input_slots.hpp"
#include "sessions/intake/upload.hpp"
#include "sessions/limits/frame_rate.hpp"
#include "sessions/sending/frame_statistics.hpp"
#include "sessions/session/accepted_frames.hpp"
#include "sessions/session/encoding_thread.hpp"
#include "sessions/session/joint_uploads.hpp"
#include "sessions/session/reconstruct_functions.hpp"
#include "sessions/session/reconstructing_thread.hpp"
#include "sessions/session/session_context.hpp"
#include "sessions/watching/watchers.hpp"

namespace meniscus::server {

/// The cause for which a session's next frame waits.
enum class SessionWait : std::uint8_t { nothing, device, bytes_in_flight };

struct SessionState {
    bool uploading = false;
    SessionWait wait = SessionWait::nothing;
    std::string waits_for;  ///< id of the session that has the device; empty: none any more, or several
    std::uint32_t watchers = 0;
    std::uint64_t frames = 0;
    std::optional<std::uint64_t> last_frame_index;
    std::optional<FrameStatistics> last_frame;  ///< of the frame answered last
    std::uint64_t frames_dropped_replaced = 0;
    std::uint64_t frames_dropped_not_nth = 0;
    std::uint64_t frames_skipped = 0;                ///< over all watchers, those that have gone included
    std::chrono::duration<double> watcher_lag{0.0};  ///< of the watcher that lags most
};

/// A pipeline of three steps that overlap: a frame is received (by its stream, into one of InputSlots) while
/// the one before is reconstructed (ReconstructingThread, into one of two meshes) and the one before that comes down
/// from the GPU and is encoded (EncodingThread). A step waits for the next one only through these slots, which is also
/// all the memory that frames take. The session itself opens and ends its streams and watchers, under one lock; each
/// thread alone uses what it owns.
///
/// join() must have returned before the last reference goes, unless no other thread has one.
class Session {
public:
    Session(SessionIdentity identity, const Settings& settings, const Limits& limits, ReconstructFunctions functions,
            SharedResources shared, SessionObservers observers = {});
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const std::string& id() const noexcept { return context_.identity.id; }
    const std::string& owner() const noexcept { return context_.identity.owner; }
    /// The account of the caller that created it; may be none.
    const std::shared_ptr<NameAccount>& account() const noexcept { return context_.identity.account; }
    const Settings& settings() const noexcept { return context_.settings; }
    /// Whether the lattice codecs can encode its meshes.
    const SessionKind& kind() const noexcept { return context_.identity.kind; }
    const std::string& name() const noexcept { return kind().description.name(); }
    std::chrono::system_clock::time_point created_at() const noexcept { return created_at_; }
    const Limits& limits() const noexcept { return context_.limits; }
    /// Another one for each session, be it of the same id, and for each run that has begun: two meshes of equal run_id,
    /// which simulators choose, and frame index may be different ones unless this is equal, too.
    std::string instance() const;
    SessionState state() const;

    // Uploading. Frames go: request_input, submit or return_input, ..., end_upload.

    /// Takes an upload that nobody else has seen, and gives it its run. One that resumes the session's run takes the
    /// place of the one before, which ends. Throws Refusal if a stream of another run uploads, or the session ends.
    void open_upload(const std::shared_ptr<Upload>& upload);
    void request_input(SlotPool<InputFrame>::Waiter waiter) { inputs_.request(std::move(waiter)); }
    void return_input(InputFrame& input) { inputs_.give_back(input); }
    /// Call it before a frame is begun. Throws LimitExceeded for one too many in a second.
    void admit_frame(std::uint64_t index);
    void submit(std::shared_ptr<Upload> upload, InputFrame& input);
    /// Tells one part of the upload, behind the answers that it is owed, that its part of the frame was passed over.
    void report_incomplete(std::shared_ptr<Upload> upload, std::uint32_t part, std::uint64_t index);
    /// Frames that were submitted before are still answered; then the upload's output ends with the error.
    void end_upload(std::shared_ptr<Upload> upload, std::exception_ptr error);
    /// Nobody reads any more: its frames that wait are forgotten.
    void cancel_upload(const std::shared_ptr<Upload>& upload, UploadEnd end = UploadEnd::answered);

    JointUploads& joint_uploads() noexcept { return joint_uploads_; }

    // Watching.

    /// The watch has the newest mesh, or its particles, at once if they are there. watcher: may be none. A snapshot is
    /// no watcher: it ends at once if no frame has come. Throws LimitExceeded, or Refusal if the session ends.
    std::shared_ptr<Watch> open_watch(const WatchOptions& options, std::function<void()> wake,
                                      const std::shared_ptr<const NameAccount>& watcher = nullptr);
    void close_watch(const std::shared_ptr<Watch>& watch);

    /// Lets the frame on its way in be the last, then ends the watchers. grace: announced to streams and watchers.
    /// Returns at once.
    void drain(std::chrono::duration<double> grace);
    /// Ends an upload that has been idle for Limits::idle_time, or for Limits::orphan_time while parts of it are
    /// missing; or whose frame comes too slowly, or whose answers are taken too slowly while frames of others wait for
    /// the bytes of its own, or are refused for its memory.
    void end_idle_upload(std::chrono::steady_clock::time_point now, bool memory_is_short);
    /// Why the session is to end, for the log: it has been without streams, watchers and calls for Limits::idle_time,
    /// or for Limits::orphan_time where its simulator has vanished without a word, or has never come though its creator
    /// said that a stream follows; or it is ephemeral and has been without a stream for Limits::ephemeral_time, or,
    /// where a stream has broken, for as long as its simulator tries to come back, but no longer than
    /// Limits::orphan_time. None: it is not.
    std::optional<std::string> unused(std::chrono::steady_clock::time_point now) const;
    /// For how long it has had no stream, since its creation or the end of the last one; none: it has one.
    std::optional<std::chrono::steady_clock::duration> without_stream(std::chrono::steady_clock::time_point now) const;
    /// Since when it has had nothing to reconstruct, and may give its buffers back; none: it has, or it works.
    std::optional<std::chrono::steady_clock::time_point> resting_since() const {
        return encoding_.idle() ? reconstructing_.resting_since() : std::nullopt;
    }
    /// Gives the buffers back, all but the newest particles and what is encoded, unless a frame comes before. Returns
    /// at once. The future is ready when it is done, or given up.
    std::future<void> release_buffers();
    /// Call it for each call about this session: it is not idle.
    void touch();
    /// A caller has joined it, to stream: an ephemeral session is kept as if it had just been created.
    void await_stream();
    /// Drops what is in flight, and ends the upload and the watchers. Returns at once. reason: for them.
    void close(std::string reason = "it was deleted");
    /// Whether the session was closed or has moved to another server, or a GPU that failed has ended it.
    bool ended() const;
    /// Of close(); empty: it has not been closed, or had ended before.
    std::string end_reason() const;
    /// After its end: waits until the session's threads have ended, and frees its memory. Once, and not from one of
    /// them.
    void join();

private:
    struct Attached {
        std::vector<std::shared_ptr<Upload>> uploads;
        std::vector<std::shared_ptr<Watch>> watches;
    };
    /// Ends the threads' work. Returns the streams and watchers to end: none from the second call on.
    Attached detach(std::string reason = {});

    // With the lock held.

    std::shared_ptr<Run> run_of(const UploadOptions& options) const;
    /// Whether a stream sends, or waits for its answers.
    bool has_stream() const;
    std::optional<std::string> unused_as_ephemeral(std::chrono::steady_clock::time_point now) const;
    /// The stream that sends from now on; may be none.
    void set_upload(std::shared_ptr<Upload> upload);
    /// Puts the frame into the queue by the upload's policy. Returns the inputs that are free again.
    std::vector<InputFrame*> enqueue(std::shared_ptr<Upload> upload, InputFrame& input);

    // Called by the upload's stream.

    /// Whether the frame that is submitted next will be, unless a newer one replaces it.
    bool is_to_be_reconstructed(const std::shared_ptr<Upload>& upload) const;

    // Called by the encoding thread.

    /// All frames of the upload have been answered; without one, only looks whether the session drains.
    void finish_upload(const std::shared_ptr<Upload>& upload, std::exception_ptr error);
    void end(const std::exception_ptr& error);

    // The steps of end_idle_upload().

    void end_slow_upload(std::chrono::steady_clock::time_point now);
    void end_stalled_uploads(std::chrono::steady_clock::time_point now, bool memory_is_short);

    const std::chrono::system_clock::time_point created_at_ = std::chrono::system_clock::now();
    std::stop_source closing_;
    const SessionContext context_;
    const std::shared_ptr<SessionInFlight> in_flight_;
    InputSlots inputs_;
    FrameQueue received_;
    Watchers watchers_;
    const std::function<FrameUpload(const ParticleFrame& frame)> send_ahead_;  ///< may be none
    FrameStop frame_stop_;
    JointUploads joint_uploads_;

    mutable std::mutex mutex_;  ///< for what follows; taken before the lock of `watchers_`
    FrameRate frame_rate_;
    std::uint64_t dropped_replaced_ = 0;
    std::uint64_t dropped_not_nth_ = 0;
    std::chrono::steady_clock::time_point last_used_ = std::chrono::steady_clock::now();
    /// By a stream or a watcher: calls that ask about an orphan do not keep it.
    std::chrono::steady_clock::time_point last_attended_ = last_used_;
    AcceptedFrames accepted_;
    std::shared_ptr<Run> run_;                         ///< of the stream opened last
    std::uint64_t runs_ = 0;                           ///< that have begun
    std::shared_ptr<Upload> upload_;                   ///< the one that sends
    std::vector<std::shared_ptr<Upload>> unanswered_;  ///< and those whose last frames are still on their way
    /// Its simulator has vanished without a word, or has not come yet, and nobody has resumed it.
    bool orphaned_ = kind().stream_follows;
    std::chrono::steady_clock::time_point without_stream_since_ = std::chrono::steady_clock::now();
    const Upload* last_upload_ = nullptr;       ///< the stream opened last, which may have gone; to know it from others
    std::chrono::milliseconds awaited_for_{0};  ///< its simulator, since its end
    bool draining_ = false;
    bool closed_ = false;
    std::string end_reason_;

    // Last: they use the others.
    EncodingThread encoding_;
    ReconstructingThread reconstructing_;
};

}  // namespace meniscus::server
