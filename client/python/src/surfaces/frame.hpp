// Frames of meshes as Python sees them.
#pragma once

#include <memory>

#include "meniscus/client/received_frame.hpp"

namespace meniscus::python {

/// The class _meniscus.Frame. Shared with its mesh and the arrays that view its memory.
struct FrameHandle {
    std::shared_ptr<const client::ReceivedFrame> frame;
};

inline FrameHandle handle_of(client::ReceivedFrame&& frame) {
    return {std::make_shared<const client::ReceivedFrame>(std::move(frame))};
}

}  // namespace meniscus::python
