// A frame that its stream's policy leaves out.
#pragma once

#include <cstdint>

namespace meniscus::server {

enum class DropReason {
    replaced,  ///< UploadPolicy::latest: a newer frame took its place
    not_nth,   ///< UploadPolicy::every_nth: not one of the n-th
};

struct DroppedFrame {
    std::uint64_t index = 0;
    DropReason reason = DropReason::replaced;
};

}  // namespace meniscus::server
