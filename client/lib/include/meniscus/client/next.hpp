// The result of a limited wait for a frame.
#pragma once

#include <optional>

namespace meniscus::client {

/// A frame; or none yet; or none any more.
template <class Frame>
struct Next {
    std::optional<Frame> frame = std::nullopt;
    bool ended = false;  ///< there is no frame, and there will be none; without either, none has come in that time

    explicit operator bool() const noexcept { return frame.has_value(); }
    const Frame& operator*() const noexcept { return *frame; }
    Frame& operator*() noexcept { return *frame; }
    const Frame* operator->() const noexcept { return &*frame; }
    Frame* operator->() noexcept { return &*frame; }
};

}  // namespace meniscus::client
