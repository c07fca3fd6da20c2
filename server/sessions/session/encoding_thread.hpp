// A session's second thread: meshes become messages, for the stream and for the watchers, each format once.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>

#include "meniscus/mesh.hpp"
#include "sessions/handover/channel.hpp"
#include "sessions/intake/upload.hpp"
#include "sessions/sending/dropped_frame.hpp"
#include "sessions/sending/frame_encoder.hpp"
#include "sessions/sending/frame_statistics.hpp"
#include "sessions/sending/scratch_pool.hpp"
#include "sessions/session/session_context.hpp"
#include "sessions/watching/watchers.hpp"

namespace meniscus::server {

/// Owns the two meshes that frames are reconstructed into: while one is encoded, the next frame takes the other.
class EncodingThread {
public:
    struct Encode {
        std::shared_ptr<Upload> upload;
        ReconstructedFrame* frame = nullptr;  ///< of wait_for_free_frame()
    };
    struct ReportDrop {
        std::shared_ptr<Upload> upload;
        DroppedFrame dropped;
    };
    struct EndUpload {
        std::shared_ptr<Upload> upload;  ///< none: the session only looks whether it drains
        std::exception_ptr error;
    };
    struct EndSession {
        std::exception_ptr error;
    };
    struct EncodeForWatchers {};
    /// The mesh of a level cap that was asked for after its frame had been reconstructed.
    struct AddCapped {
        std::uint64_t frame_number = 0;
        int max_level = 0;
        Mesh mesh;
    };
    /// The newest frame, made again after release_meshes().
    struct ShowAgain {
        ReconstructedFrame* frame = nullptr;  ///< of wait_for_free_frame()
    };
    enum class Newest : std::uint8_t { release, keep };
    /// The task of release_meshes().
    struct ReleaseMeshes {
        std::shared_ptr<std::promise<void>> done;
        Newest newest = Newest::release;
    };
    using Task =
        std::variant<Encode, ReportDrop, EndUpload, EndSession, EncodeForWatchers, AddCapped, ShowAgain, ReleaseMeshes>;

    /// The thread calls these of its session, in the order of the tasks.
    struct Ends {
        /// All frames of the upload have been answered.
        std::function<void(const std::shared_ptr<Upload>&, std::exception_ptr)> upload;
        std::function<void(std::exception_ptr)> session;
    };

    /// The arguments that are references outlive the thread.
    EncodingThread(const SessionContext& context, Watchers& watchers, Ends ends);
    ~EncodingThread();
    EncodingThread(const EncodingThread&) = delete;
    EncodingThread& operator=(const EncodingThread&) = delete;

    // Thread-safe.

    /// Waits for a mesh to reconstruct into; none once the thread is closed.
    ReconstructedFrame* wait_for_free_frame();
    /// Dropped once the thread is closed.
    void put(Task task) {
        ++pending_;
        if (std::holds_alternative<Encode>(task)) ++frames_waiting_;
        tasks_.put(std::move(task));
    }
    /// A watcher has come. Puts one task for all that come until it is done.
    void look_for_watchers() {
        if (!looks_for_watchers_.exchange(true)) put(EncodeForWatchers{});
    }
    /// Whether it has nothing to do.
    bool idle() const noexcept { return pending_ == 0; }
    /// Frees the meshes and the memory that they are encoded in, once the tasks before are done. What is encoded stays.
    /// Only while no frame is lent. Returns false if the thread is closed.
    bool release_meshes(Newest newest);
    /// The statistics of the frame answered last.
    std::optional<FrameStatistics> last_frame() const;
    /// Drops the tasks that wait. Returns at once.
    void close();
    /// Once it is closed. Not from the thread itself.
    void join();
    /// Frees all of it; once it was joined.
    void release_memory();

private:
    void run();
    void perform(Encode& task);
    void perform(ReportDrop& task);
    void perform(EndUpload& task);
    void perform(EndSession& task);
    void perform(EncodeForWatchers& task);
    void perform(AddCapped& task);
    void perform(ShowAgain& task);
    void perform(ReleaseMeshes& task);

    /// Goes on with watchers' formats as long as it would wait.
    void wait_for_room(Upload& upload);
    /// Answers a frame of a resumed run that was finished before: for the simulator alone.
    void answer_again(Encode& task);
    /// One answer less is owed.
    void answered(Upload& upload);
    void count_answer(const FrameStatistics& statistics);
    void give_back(ReconstructedFrame& frame);

    std::shared_ptr<const EncodedFrame> encode_newest(const MeshFormat& format, const MessageSink& sink,
                                                      bool spray_to_sink = false);
    /// Encodes the newest mesh in formats that watchers ask for and nobody has published, until a frame waits: the
    /// simulator comes first, and a format may skip frames.
    void encode_for_watchers();
    /// For the watchers whose turn it is. Returns false if there is none, or it failed.
    bool encode_in_one_format();
    void encode_for(SessionObserver& observer);

    const SessionContext& context_;
    Watchers& watchers_;
    const Ends ends_;

    std::array<ReconstructedFrame, 2> frames_;
    Channel<ReconstructedFrame*> free_frames_;
    Channel<Task> tasks_;
    std::atomic<int> pending_{0};         ///< tasks that were put and are not done
    std::atomic<int> frames_waiting_{0};  ///< of those, frames that were not begun
    std::atomic<bool> looks_for_watchers_{false};
    ReconstructedFrame* newest_ = nullptr;
    ScratchPool scratch_;
    Encodings before_;  ///< of frames before the newest, whose bricks may serve again

    mutable std::mutex mutex_;  ///< for what follows
    std::optional<FrameStatistics> last_frame_;

    std::thread thread_;  ///< last: it uses the others
};

}  // namespace meniscus::server
