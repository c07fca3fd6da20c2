// Protobuf messages one after the other, each after its length in bytes as a varint, from front to back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "files/recording_checksums.hpp"
#include "formats/recordings/input_pipe.hpp"

namespace meniscus::formats {

/// As files::DelimitedMessages, but of what can be read once alone.
class PipedMessages {
public:
    /// Borrows the pipe.
    explicit PipedMessages(InputPipe& in) : in_(in) {}

    /// Whether these bytes are next; none of them is read. Waits for no more than the first that differs. magic: no
    /// longer than the buffer.
    bool follows(std::string_view magic);
    /// Reads these bytes. False if there are others.
    bool begins_with(std::string_view magic);

    /// Byte that is read next, from 0.
    std::uint64_t position() const noexcept { return position_; }
    /// The next messages are those of a frame, `bytes` together. where: of the frame, for errors.
    void begin_frame(std::uint64_t bytes, std::string where, bool with_checksum);
    /// Whether all bytes of the frame have been read.
    bool at_end() const noexcept { return frame_left_ == 0; }
    /// The next messages are those of a frame of which nobody has told the bytes. where: of the frame, for errors;
    /// empty: it is over.
    void name_place(std::string where) { where_ = std::move(where); }
    /// Reads the rest of the frame, and forgets it.
    void skip_frame();
    /// The frame is over; the checksum of its bytes, if it was asked for.
    std::optional<std::uint64_t> end_frame();

    /// The next message's bytes. None: within a frame, if its end cuts them; else at the end of the pipe. Throws
    /// InvalidInput for a length beyond the limit, before memory is taken for it, and for a pipe that ends in between.
    std::optional<std::string> next(std::size_t limit);

    /// Throws InvalidInput: "NAME: message".
    [[noreturn]] void fail(const std::string& message) const { in_.fail(message); }
    /// Throws InvalidInput, which says that the pipe has ended too early.
    [[noreturn]] void fail_cut() const;

private:
    /// Bytes that were read from the pipe and not taken; none at its end.
    std::string_view ahead();
    void take(std::size_t bytes);
    /// Appends `bytes` of the pipe.
    void append(std::uint64_t bytes, std::string& out);

    InputPipe& in_;
    std::array<char, std::size_t{64} << 10> buffer_{};
    std::size_t first_ = 0;  ///< of the bytes in it that are not taken
    std::size_t end_ = 0;
    std::uint64_t position_ = 0;
    std::optional<std::uint64_t> frame_left_;  ///< bytes of the frame; none between frames
    std::string where_;
    std::optional<files::RunningChecksum> checksum_;
};

}  // namespace meniscus::formats
