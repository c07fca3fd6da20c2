// One simulator's settings, buffers, latest mesh and watchers.
#pragma once

#include <array>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "meniscus/mesh.hpp"
#include "meniscus/settings.hpp"
#include "sessions/frame_encoder.hpp"
#include "sessions/frame_queue.hpp"
#include "sessions/handover/channel.hpp"
#include "sessions/handover/slot_pool.hpp"
#include "sessions/input_frame.hpp"
#include "sessions/limits/frame_rate.hpp"
#include "sessions/limits/limits.hpp"
#include "sessions/particle_messages.hpp"
#include "sessions/reconstruct_functions.hpp"
#include "sessions/session_observer.hpp"
#include "sessions/shared_resources.hpp"
#include "sessions/upload.hpp"
#include "sessions/watch.hpp"

namespace meniscus::server {

struct SessionState {
    bool uploading = false;
    std::uint32_t watchers = 0;
    std::uint64_t frames = 0;
    std::optional<std::uint64_t> last_frame_index;
    std::optional<FrameStatistics> last_frame;  ///< of the frame answered last
    std::uint64_t frames_dropped_replaced = 0;
    std::uint64_t frames_dropped_not_nth = 0;
    std::uint64_t frames_skipped = 0;                ///< over all watchers, those that have gone included
    std::chrono::duration<double> watcher_lag{0.0};  ///< of the watcher that lags most
};

struct SessionIdentity {
    std::string id;
    std::string owner{};  ///< who made it; empty where nobody is asked
};

/// A pipeline of three steps that overlap: a frame is received (by its stream, into one of two input slots) while the
/// one before is reconstructed (first thread, into one of two meshes) and the one before that comes down from the GPU
/// and is encoded (second thread). A step waits for the next one only through these slots, which is also all the memory
/// that frames take. UploadPolicy::latest has a third input slot: for the frame that waits, and is replaced once a
/// newer one is complete.
///
/// join() must have returned before the last reference goes, unless no other thread has one.
class Session {
public:
    /// observer: may be none.
    Session(SessionIdentity identity, const Settings& settings, const Limits& limits, ReconstructFunctions functions,
            SharedResources shared, std::shared_ptr<SessionObserver> observer = nullptr);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const std::string& id() const noexcept { return identity_.id; }
    const std::string& owner() const noexcept { return identity_.owner; }
    const Settings& settings() const noexcept { return settings_; }
    const Limits& limits() const noexcept { return limits_; }
    SessionState state() const;

    // Uploading. Frames go: request_input, submit or return_input, ..., end_upload.

    /// A stream that resumes the session's run takes the place of the one before, which ends. Throws Refusal if a
    /// stream of another run uploads, or the session ends.
    std::shared_ptr<Upload> open_upload(const UploadOptions& options, std::function<void()> wake,
                                        std::function<void()> drain);
    void request_input(SlotPool<InputFrame>::Waiter waiter);
    void return_input(InputFrame& input);
    /// Before a frame is begun. Throws LimitExceeded for one too many in a second.
    void admit_frame(std::uint64_t index);
    void submit(std::shared_ptr<Upload> upload, InputFrame& input);
    /// What was submitted before is still answered; then the upload's output ends with the error.
    void end_upload(std::shared_ptr<Upload> upload, std::exception_ptr error);
    /// Nobody reads any more: its frames that wait are forgotten.
    void cancel_upload(const std::shared_ptr<Upload>& upload);

    // Watching.

    /// Gets the newest mesh, or its particles, at once where they are there. Throws LimitExceeded, or Refusal if the
    /// session ends.
    std::shared_ptr<Watch> open_watch(const WatchWishes& wishes, std::function<void()> wake);
    void close_watch(const std::shared_ptr<Watch>& watch);

    /// Lets the frame on its way in be the last, then ends the watchers. Streams and watchers are told that they have
    /// so long. Returns at once.
    void drain(std::chrono::duration<double> grace);
    /// Ends an upload that has been idle for Limits::idle_time. Returns whether the session has been without a stream,
    /// a watcher or a call for so long.
    bool end_idle(std::chrono::steady_clock::time_point now);
    /// A call is about this session.
    void touch();
    /// Drops what is in flight, and ends the upload and the watchers. Returns at once.
    void close();
    /// Whether the session was closed or has moved to another server, or a GPU that failed has ended it.
    bool ended() const;
    /// After its end: waits until the session's threads have ended. Once, and not from one of them.
    void join();

private:
    struct Encode {
        std::shared_ptr<Upload> upload;
        ReconstructedFrame* frame = nullptr;
    };
    struct ReportDrop {
        std::shared_ptr<Upload> upload;
        DroppedFrame dropped;
    };
    struct EndUpload {
        std::shared_ptr<Upload> upload;  ///< none: only looks whether the session drains
        std::exception_ptr error;
    };
    struct EndSession {
        std::exception_ptr error;
    };
    struct EncodeForWatchers {};
    /// The mesh of a cap that was wished for after its frame had been reconstructed.
    struct AddCapped {
        std::uint64_t frame_number = 0;
        int max_level = 0;
        Mesh mesh;
    };
    using Task = std::variant<Encode, ReportDrop, EndUpload, EndSession, EncodeForWatchers, AddCapped>;

    using Encodings = std::map<MeshFormat, std::shared_ptr<const EncodedFrame>>;

    struct Attached {
        std::vector<std::shared_ptr<Upload>> uploads;
        std::vector<std::shared_ptr<Watch>> watches;
    };
    /// Ends the threads' work. Returns whom to tell: nobody from the second call on.
    Attached detach();

    std::shared_ptr<Run> run_of(const UploadOptions& options) const;
    /// As the upload's policy says. Returns the inputs that are free again. With the lock held.
    std::vector<InputFrame*> enqueue(std::shared_ptr<Upload> upload, InputFrame& input);

    void reconstruct_frames();
    void pass_on(Received note);
    /// False if the session ends.
    bool reconstruct_next(Received received);
    void reconstruct(const Received& received, ReconstructedFrame& frame);
    /// To the observer and to those who watch particles, unless they have seen the frame already, before its run was
    /// resumed.
    void show(const Received& received);
    /// With the level caps that watchers wish for now.
    void cap_levels(ReconstructedFrame& frame);
    /// Of the last frame, for a watcher who has come since.
    void cap_levels_again(int max_level);
    bool emit_capped(int max_level, Mesh& mesh);
    bool is_wished_for(int max_level) const;

    /// Encodes the input's particles for the watchers whose wish nobody shared.
    void show_particles(const InputFrame& input);
    /// Of the last frame, for a watcher who has come since.
    void show_particles_again();
    /// The last frame's input, unless another frame is on its way into it.
    InputFrame* take_back_newest_input();
    std::optional<std::uint64_t> unpublished_particles() const;
    void publish(std::uint64_t max_particles, const std::shared_ptr<const ParticleMessages>& particles);

    void encode_frames();
    void give_back(ReconstructedFrame& frame);
    void perform(Encode& task);
    /// A frame of a resumed run that was finished before: for the simulator alone.
    void answer_again(Encode& task);
    void answered(Upload& upload);
    void perform(ReportDrop& task);
    void perform(EndUpload& task);
    void perform(EndSession& task);
    void perform(EncodeForWatchers& task);
    void perform(AddCapped& task);
    /// A frame was answered with these statistics.
    void count_answer(const FrameStatistics& statistics);
    std::shared_ptr<const EncodedFrame> encode_newest(const MeshFormat& format, const MessageSink& sink);
    void publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame);
    /// Encodes the newest mesh for the watchers whose wishes nobody shared.
    void encode_for_watchers();
    void encode_for_observer();
    std::optional<MeshFormat> unpublished_format() const;

    const SessionIdentity identity_;
    const Settings settings_;
    const Limits limits_;
    const ReconstructFunctions functions_;
    const SharedResources shared_;
    const std::shared_ptr<SessionObserver> observer_;

    std::array<InputFrame, 3> inputs_;  ///< the last one for UploadPolicy::latest
    std::array<ReconstructedFrame, 2> frames_;
    SlotPool<InputFrame> free_inputs_;
    FrameQueue received_;
    Channel<ReconstructedFrame*> free_frames_;
    Channel<Task> tasks_;
    std::uint64_t reconstructed_ = 0;          ///< frames; of the reconstructing thread
    ReconstructedFrame* next_mesh_ = nullptr;  ///< of the same: taken before it is needed
    InputFrame* newest_input_ = nullptr;       ///< of the same: of the frame that was shown last
    std::shared_ptr<Upload> failed_;           ///< of the same: its frames that follow are dropped
    ReconstructedFrame* newest_ = nullptr;     ///< of the encoding thread
    Encodings before_;  ///< of the frame before the newest, whose bricks may serve again; of the same thread

    mutable std::mutex mutex_;  ///< for what follows
    SessionState state_;
    FrameRate frame_rate_;
    std::chrono::steady_clock::time_point last_used_ = std::chrono::steady_clock::now();
    std::shared_ptr<Run> run_;  ///< of the stream opened last
    bool third_input_in_use_ = false;
    std::shared_ptr<Upload> upload_;                   ///< the one that sends
    std::vector<std::shared_ptr<Upload>> unanswered_;  ///< and those whose last frames are still on their way
    std::vector<std::shared_ptr<Watch>> watches_;
    Encodings published_;  ///< the newest mesh
    std::map<std::uint64_t, std::shared_ptr<const ParticleMessages>>
        particles_;  ///< of the newest frame, by max_particles
    bool draining_ = false;
    bool closed_ = false;

    std::thread reconstructing_;
    std::thread encoding_;
};

}  // namespace meniscus::server
