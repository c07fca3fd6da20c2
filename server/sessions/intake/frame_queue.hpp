// A session's frames between their arrival and their reconstruction.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "meniscus/frame_upload.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/intake/upload.hpp"
#include "sessions/sending/dropped_frame.hpp"

namespace meniscus::server {

/// A frame, or a note that keeps its place among the frames.
struct Received {
    std::shared_ptr<Upload> upload = nullptr;
    InputFrame* input = nullptr;               ///< the frame; none: a note
    std::optional<DroppedFrame> dropped = {};  ///< a note of a dropped frame
    bool watchers = false;                     ///< or of watchers that have come and miss something
    std::shared_ptr<std::promise<void>> release =
        nullptr;                         ///< or that the buffers are to be given back: dropped when that is done
    std::exception_ptr error = nullptr;  ///< or that the upload ends, with this
};

/// A frame can be replaced or withdrawn until it is taken. Therefore the one thread that takes frames first waits for
/// one, makes ready, and then takes what is there by then.
class FrameQueue {
public:
    enum class Next { frame, note, closed };

    /// Dropped once the queue is closed. One note of watchers is enough for all that come until it is taken.
    void put(Received received);
    /// Notes in place of the upload's frames that wait, each as replaced. Returns the frames.
    std::vector<InputFrame*> replace(const Upload& upload);
    /// The waiting frames' copies that were sent ahead, to be withdrawn. The frames stay, and may be taken meanwhile.
    std::vector<FrameUpload> sent_ahead(const Upload& upload);
    /// Forgets the frames and the dropped ones of the upload. Returns the frames.
    std::vector<InputFrame*> withdraw(const Upload& upload);

    /// Waits for a frame or a note, and returns which one is first.
    Next wait();
    /// Takes the first in the queue if it is of this kind, which it need not be any more.
    std::optional<Received> take(Next kind);

    /// Drops what has not been taken. Returns the inputs of the frames among it, which are free again.
    std::vector<InputFrame*> close();

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Received> waiting_;
    bool closed_ = false;
};

}  // namespace meniscus::server
