// The reports of a session about its frames, to its recording and its publication.
#pragma once

#include <memory>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/codec.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// Called by the session's threads, which wait meanwhile: implementations return soon, and throw nothing.
class SessionObserver {
public:
    /// The bits of the normals in the meshes that encoded() is called with.
    static constexpr int normal_bits = 8;

    virtual ~SessionObserver() = default;
    /// The name of its product, for the log.
    virtual const char* product() const noexcept = 0;
    /// The codec of those meshes, where the session can encode it; otherwise it is Draco.
    virtual Codec codec() const noexcept { return Codec::draco; }
    /// The bits of all attributes in those meshes; see AttributeWish.
    virtual int attribute_bits() const noexcept { return default_attribute_bits; }
    /// A frame that was reconstructed, in the order of arrival. Borrowed.
    virtual void reconstructed(const InputFrame& frame) noexcept = 0;
    /// Its mesh, in the same order. Meanwhile the next frame may have been reconstructed, by another thread.
    virtual void encoded(std::shared_ptr<const EncodedFrame> frame) noexcept = 0;
    /// No other frame comes: the session has ended. May be called again.
    virtual void ended() noexcept {}
};

using SessionObservers = std::vector<std::shared_ptr<SessionObserver>>;

}  // namespace meniscus::server
