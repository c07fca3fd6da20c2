// A session's first thread: frames, in their order and turn, become meshes.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "sessions/intake/brick_reader.hpp"
#include "sessions/intake/frame_queue.hpp"
#include "sessions/intake/frame_stop.hpp"
#include "sessions/intake/input_slots.hpp"
#include "sessions/session/encoding_thread.hpp"
#include "sessions/session/reconstruct_functions.hpp"
#include "sessions/session/session_context.hpp"
#include "sessions/session/shown_particles.hpp"
#include "sessions/watching/watchers.hpp"

namespace meniscus::server {

/// Takes from `received` until that is closed. Passes meshes, and the notes among the frames, to the encoding thread.
class ReconstructingThread {
public:
    using Clock = std::chrono::steady_clock;

    struct Progress {
        std::uint64_t frames = 0;
        std::optional<std::uint64_t> last_frame_index;
    };

    /// All that is passed by reference outlives the thread.
    ReconstructingThread(const SessionContext& context, ReconstructFunctions functions, FrameQueue& received,
                         InputSlots& inputs, Watchers& watchers, EncodingThread& encoding, FrameStop& stop);

    /// Thread-safe.
    Progress progress() const;
    /// Whether a frame waits for its turn on the device. Thread-safe.
    bool waits_for_turn() const noexcept { return waits_for_turn_; }
    /// Since when it has had no frame and no watcher to work for, and may give its buffers back; none: it works, or has
    /// given them back. Thread-safe.
    std::optional<Clock::time_point> resting_since() const;
    /// Once `received` and the encoding thread are closed.
    void join();
    /// Frees all of it; once it was joined, and after the encoding thread's memory.
    void release_memory();

private:
    void run();
    void pass_on(Received note);
    /// The turn ends with the reconstruction. Returns whether the session goes on.
    bool reconstruct_next(Received received, Turns::Turn turn);
    /// Calls work in this turn, which ends with it. Beside one that leads, a session may hold as much memory as no
    /// other may take; where that is too little, work is called again in a turn that leads. Returns false, without
    /// having called it to its end, if the session ends, or if there is no turn.
    bool in_turn(std::optional<Turns::Turn> turn, const std::function<void()>& work);
    void reconstruct(const Received& received, ReconstructedFrame& frame);
    /// Makes the frame's surface and statistics of what has come.
    void make_surface(InputFrame& input, ReconstructedFrame& frame);
    /// Why a frame was stopped, for its stream.
    [[noreturn]] void throw_stopped(std::uint64_t index) const;
    /// Works from here on, until rest(). Returns its turn; none if the session ends.
    std::optional<Turns::Turn> begin_work(Turns::Needs needs = Turns::Needs::any_turn);
    void rest();
    /// Gives back all memory but the newest particles, which meshes are made of again, and what is encoded.
    void release_buffers();
    /// Makes what watchers that have come miss of the newest frame, unless they have gone again.
    void serve_watchers();
    /// Makes the newest meshes again, for a watcher that has come since.
    void make_meshes_again();
    /// Adds the meshes of coarser levels that watchers ask for now.
    void cap_levels(ReconstructedFrame& frame);
    /// Makes such a mesh of the last frame, for a watcher that has come since.
    void cap_levels_again(int max_level);
    bool emit_capped(int max_level, Mesh& mesh);

    const SessionContext& context_;
    ReconstructFunctions functions_;
    FrameQueue& received_;
    InputSlots& inputs_;
    Watchers& watchers_;
    EncodingThread& encoding_;
    FrameStop& stop_;

    BrickReader bricks_;
    ShownParticles particles_;
    /// The figures of the frame that was shown last, with which its meshes are made again.
    struct Shown {
        std::uint64_t number = 0;
        std::uint64_t run_id = 0;
        Statistics statistics;
    };
    Shown shown_;
    bool meshes_released_ = false;
    ReconstructedFrame* next_mesh_ = nullptr;  ///< taken before it is needed
    bool has_surface_ = false;                 ///< of a frame, so that it can be emitted again
    bool has_finished_bricks_ = false;         ///< in place of a surface
    std::array<bool, 2> capped_{};             ///< whether that was done at levels 1 and 2
    bool may_have_more_memory_ = false;        ///< whether a turn that leads would give it more than this one
    std::shared_ptr<Upload> failed_;           ///< its frames that follow are dropped

    std::atomic<bool> waits_for_turn_{false};
    mutable std::mutex mutex_;                                       ///< for what follows
    Progress progress_;                                              ///< written by the thread alone
    std::optional<Clock::time_point> resting_since_ = Clock::now();  ///< frames may come, and never be complete

    std::thread thread_;  ///< last: it uses the others
};

}  // namespace meniscus::server
