// Who wants to know what a session does: its recording.
#pragma once

#include <memory>

#include "sessions/encoded_frame.hpp"
#include "sessions/input_frame.hpp"

namespace meniscus::server {

/// Called by the session's threads, which wait meanwhile: implementations return soon, and throw nothing.
class SessionObserver {
public:
    /// Of the normals of the meshes that encoded() gets.
    static constexpr int normal_bits = 8;

    virtual ~SessionObserver() = default;
    /// A frame that was reconstructed, in the order of arrival. Borrowed.
    virtual void reconstructed(const InputFrame& frame) noexcept = 0;
    /// Its mesh, in the same order. Meanwhile the next frame may have been reconstructed, by another thread.
    virtual void encoded(std::shared_ptr<const EncodedFrame> frame) noexcept = 0;
};

}  // namespace meniscus::server
