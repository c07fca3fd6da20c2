#include "rpc/messages/session_description.hpp"

#include <fmt/format.h>

#include "description/label.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

v1::SessionDescription checked_description(const v1::SessionDescription& wire) {
    description::require_name(wire.name(), "description.name");
    description::require_length_unit(wire.length_unit(), "description.length_unit");
    if (!v1::UpAxis_IsValid(wire.up_axis()))
        throw InvalidInput(fmt::format("description.up_axis has the value {}, which this version does not know",
                                       static_cast<int>(wire.up_axis())));
    v1::SessionDescription description = wire;
    description.DiscardUnknownFields();
    return description;
}

}  // namespace meniscus::server
