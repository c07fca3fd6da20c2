// A frame that its stream's policy leaves out.
#pragma once

#include <cstdint>
#include <string_view>

namespace meniscus::server {

enum class DropReason {
    replaced,  ///< UploadPolicy::latest: a newer frame took its place
    not_nth,   ///< UploadPolicy::every_nth: not one of the n-th
};
constexpr std::string_view name_of(DropReason reason) {
    switch (reason) {
        case DropReason::replaced:
            return "replaced";
        case DropReason::not_nth:
            return "not_nth";
    }
    return {};
}

struct DroppedFrame {
    std::uint64_t index = 0;
    DropReason reason = DropReason::replaced;
};

}  // namespace meniscus::server
