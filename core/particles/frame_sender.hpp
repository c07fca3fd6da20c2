// The interface that sends a frame's particles ahead of its reconstruction.
#pragma once

#include <cstdint>

#include "meniscus/frame_upload.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus {

class FrameSender : public FrameUpload::Sender {
public:
    /// Begins to copy the frame's arrays, all of which become attributes. Returns its number, 0 where nothing was
    /// begun: then its reconstruction sends it. For any thread.
    virtual std::uint64_t send(const ParticleFrame& frame) noexcept = 0;
};

}  // namespace meniscus
