// A frame that is left out: by its stream's policy, or since a part of it is missing.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace meniscus::server {

enum class DropReason {
    replaced,    ///< UploadPolicy::latest: a newer frame took its place
    not_nth,     ///< UploadPolicy::every_nth: not one of the n-th
    incomplete,  ///< another part has gone on to a later frame
};
constexpr std::string_view name_of(DropReason reason) {
    switch (reason) {
        case DropReason::replaced:
            return "replaced";
        case DropReason::not_nth:
            return "not_nth";
        case DropReason::incomplete:
            return "incomplete";
    }
    return {};
}

struct DroppedFrame {
    std::uint64_t index = 0;
    DropReason reason = DropReason::replaced;
    std::optional<std::uint32_t> part = {};  ///< the one that is told; none: all
};

}  // namespace meniscus::server
