// Frames of finished bricks that are read once, from front to back, as they are written: from a pipe, or from a file.
// files/brick_file_format.hpp describes the bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "formats/bytes/read_limits.hpp"
#include "formats/recordings/piped_messages.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {
class FrameReceiver;
}

namespace meniscus::formats {

/// One file, or several behind one another. One whose indices begin again, as those of files of a sequence do, goes on
/// with the next ones: indices rise.
class BrickStream {
public:
    /// Reads the first file's beginning, and borrows the messages. limits: of a frame's bytes. Throws InvalidInput, in
    /// one line that names the input and the byte, for what is no file of bricks.
    explicit BrickStream(PipedMessages& messages, const ReadLimits& limits = {});
    ~BrickStream();

    /// Waits for the next frame, whose bricks stay encoded; none at the end. Throws InvalidInput, in one line that
    /// names the input, the frame and the byte, for what is no frame, and where it ends within one.
    std::optional<client::ReceivedFrame> next();

private:
    void begin_file();
    /// The next message; none at the end of the pipe between two frames.
    std::optional<v1::StreamResponse> message();
    void begin_frame(const v1::MeshBegin& message);
    [[noreturn]] void fail(const std::string& what) const;

    PipedMessages& messages_;
    ReadLimits limits_;
    std::unique_ptr<client::FrameReceiver> receiver_;
    std::uint64_t message_at_ = 0;
    bool in_frame_ = false;
    bool is_new_file_ = true;                  ///< none of its frames has begun
    std::uint64_t shift_ = 0;                  ///< from the index in the file to that of the frame
    std::uint64_t frame_bytes_ = 0;            ///< of its messages so far
    std::optional<std::uint64_t> last_frame_;  ///< index of the one that began last
};

}  // namespace meniscus::formats
