// The frames of a stream that sends no parts, as its session receives them.
#pragma once

#include <cstddef>
#include <span>

#include "sessions/intake/frame_assembler.hpp"
#include "sessions/intake/frame_plan.hpp"

namespace meniscus::server::test {

class WholeFrames {
public:
    explicit WholeFrames(const Limits& limits, const Settings& settings = {})
        : limits_(limits), assembler_(limits, settings) {}

    void begin(const v1::FrameBegin& message, InputFrame& frame) {
        const FramePart whole = assembler_.announce(message);
        assembler_.place(whole, begin_frame(std::span(&whole, 1), limits_, frame).front());
    }
    void append(const v1::FrameChunk& chunk, InputFrame& frame) { assembler_.append(chunk, frame); }
    void end() { assembler_.end(); }
    void end_of_stream() const { assembler_.end_of_stream(); }

    bool in_frame() const { return assembler_.in_frame(); }
    std::size_t expected() const { return assembler_.expected(); }
    /// Bytes of the frame that are in their places, since this was asked last.
    std::size_t take_kept() { return assembler_.take_kept(); }

private:
    const Limits limits_;
    FrameAssembler assembler_;
};

/// The bytes of all arrays of a frame, without those that align them.
inline std::size_t bytes_of(const ParticleFrame& frame) {
    std::size_t bytes = frame.positions.size_bytes() + frame.quantized.size_bytes() + frame.levels.size_bytes();
    for (const ParticleArray& array : frame.arrays) bytes += array.data.size();
    return bytes;
}

}  // namespace meniscus::server::test
