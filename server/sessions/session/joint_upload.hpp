// The streams that each send a part of every frame, as one stream of their session.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sessions/intake/frame_plan.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/intake/upload.hpp"

namespace meniscus::server {

class Session;

/// One of the streams, as the joint upload calls it. Thread-safe.
class PartStream {
public:
    virtual ~PartStream() = default;
    /// Upload::output has something again, or its end.
    virtual void wake() = 0;
    /// A buffer is there: the next message is the beginning of a frame.
    virtual void read_next() = 0;
    /// All parts have begun the frame: its chunks may come. Called, as enter() was, by whichever part was the last.
    /// pieces: see begin_frame(); none: the frame's bytes are to be passed over.
    virtual void begun(std::optional<std::vector<FramePiece>> pieces) = 0;
    /// Nothing that it reads is wanted any more.
    virtual void stop_reading() = 0;
};

/// A frame begins once all parts have announced it, and their numbers of particles are known: then it has one buffer,
/// and each part writes to its place there. So no byte of a frame arrives, and is booked as in flight, while a part is
/// still to come; to everything behind this class it is a frame of one stream, which that has sent faster. A stream
/// that sends whole frames is a joint upload of one part.
///
/// It ends as a whole: whatever ends one of the streams ends all of them. Those of simulators that reconnect come
/// again, and begin with the first frame without an answer. Where that differs, or a part leaves out a frame or sends
/// no more, the others pass the frame over, and are told that it is incomplete.
///
/// Thread-safe. No lock is held while the session or a stream is called.
class JointUpload : public std::enable_shared_from_this<JointUpload> {
public:
    /// Takes part in the session's upload of that run, or begins it. Throws Refusal as Session::open_upload(), and for
    /// a part that is there already; InvalidInput for options that differ from those of the other parts. part: below
    /// options.parts.
    static std::shared_ptr<JointUpload> open(const std::shared_ptr<Session>& session, const UploadOptions& options,
                                             std::uint32_t part, const std::weak_ptr<PartStream>& stream);
    /// See open().
    JointUpload(std::shared_ptr<Session> session, std::uint32_t parts) : session_(std::move(session)), parts_(parts) {}

    const std::shared_ptr<Upload>& upload() const noexcept { return upload_; }
    bool has_parts() const noexcept { return parts_.size() > 1; }

    // The reading side of a part; between enter() and leave() the buffer is there, from read_next() on.

    /// Call it when the last frame, if any, is done with. read_next() follows.
    void ready(std::uint32_t part);
    /// False if nothing is wanted any more.
    bool enter();
    void leave();
    InputFrame& input() const noexcept { return *input_; }
    /// begun() follows.
    void begin(std::uint32_t part, FramePart announced);
    /// Of the part's bytes, this many more are in their places. As FrameInFlight::book().
    bool book(std::size_t bytes, std::function<void()> booked);
    /// The part's bytes are all there. read_next() follows.
    void end(std::uint32_t part);
    /// No further frame of this part follows.
    void close(std::uint32_t part);
    /// The connection of this part is broken.
    void lose(std::uint32_t part);
    /// Between two frames: the simulator goes on with another server.
    void move();
    /// Frames that are complete are still answered; then all streams end with the error, which names the part.
    void fail(std::uint32_t part, const std::exception_ptr& error);

    /// The call of one stream has been finished.
    void finished() { stop_reading(); }
    /// And is over.
    void done(std::uint32_t part, UploadEnd end);

private:
    enum class State : std::uint8_t { absent, busy, ready, reading, begun, sending, passing_over, closed };
    struct Part {
        State state = State::absent;  ///< closed: it sends no more, or has done so before the run was resumed
        bool is_present = false;
        std::weak_ptr<PartStream> stream;
        FramePart announced;
    };

    void make_upload(const UploadOptions& options);
    /// False if it has ended. Throws as open().
    bool take_part(const UploadOptions& options, std::uint32_t part, const std::weak_ptr<PartStream>& stream);
    /// If all parts are ready.
    void request_input();
    bool use_input(InputFrame& input);
    /// Begins the frame if all parts have announced it; those that have announced an earlier one, or one that another
    /// part does not send, pass that over.
    void resolve();
    void begin_frame_of_all();
    void submit();
    /// Whatever is wrong with one part, or the frame of all.
    void end_with(const std::exception_ptr& error);
    /// After the frame on its way in.
    void end_between_frames(const std::exception_ptr& error);
    /// Returns false if that was done before.
    bool stop_reading();
    void break_off(const std::string& reason);
    /// The part has been answered well, over a stream before.
    void go_on_without(std::uint32_t part);
    std::shared_ptr<PartStream> stream_of(std::size_t part) const;

    // With the lock held.
    bool all_that_send_are(State state) const;
    bool has(State state) const;
    /// By their parts; none for a part that has not come, or has gone.
    std::vector<std::shared_ptr<PartStream>> streams() const;

    const std::shared_ptr<Session> session_;
    std::shared_ptr<Upload> upload_;  ///< set once, before others see this
    UploadOptions options_;           ///< of the part that came first

    mutable std::mutex mutex_;  ///< for what follows
    std::vector<Part> parts_;
    std::uint32_t present_ = 0;
    std::uint32_t done_ = 0;
    UploadEnd end_ = UploadEnd::answered;
    InputFrame* input_ = nullptr;  ///< from use_input() until the frame is submitted
    bool input_requested_ = false;
    int working_ = 0;        ///< parts between enter() and leave()
    bool in_frame_ = false;  ///< begun by all
    bool closed_ = false;    ///< by all parts
    bool ended_ = false;
    std::exception_ptr ends_with_;  ///< after the frame

    std::size_t kept_bytes_ = 0;           ///< of the frame, over all its pieces
    std::atomic<std::size_t> arrived_{0};  ///< of those
};

}  // namespace meniscus::server
