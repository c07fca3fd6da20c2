// The common part of streams and publishers: frames that are sent one after the other.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <mutex>
#include <optional>

#include "sessions/frame_source.hpp"

namespace meniscus::python {

/// Indices of frames, each above the one before.
class RisingIndex {
public:
    /// That of the next frame. given: none for the one after the last. Throws InvalidInput for one that is not above.
    std::uint64_t next(std::optional<std::uint64_t> given) const;
    void note(std::uint64_t sent) { last_ = sent; }

private:
    std::optional<std::uint64_t> last_;
};

/// Upload: a Stream or a Publisher.
template <class Upload>
class FrameUpload : public FrameSource<Upload> {
public:
    using FrameSource<Upload>::FrameSource;

    void finish() {
        require_own_process();
        without_lock([this] { this->source_.finish(); });
    }
    std::uint64_t dropped() const { return this->source_.dropped(); }

protected:
    /// Calls send(index), in its turn, without the interpreter's lock. Ctrl-C cancels the upload. Returns the index.
    template <class Send>
    std::uint64_t send_in_turn(std::optional<std::uint64_t> given, const Send& send) {
        std::uint64_t index = 0;
        wait_for(
            [&] {
                const std::lock_guard turn(push_turn_);
                index = index_.next(given);
                send(index);
                index_.note(index);
            },
            [this] { this->source_.cancel(); });
        return index;
    }

    std::mutex push_turn_;  ///< for what follows
    RisingIndex index_;
};

}  // namespace meniscus::python
