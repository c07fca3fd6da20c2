#include "receiving/session_description.hpp"

#include "description/label.hpp"

namespace meniscus::client {

namespace {

v1::UpAxis to_wire(UpAxis axis) {
    switch (axis) {
        case UpAxis::unspecified:
            return v1::UP_AXIS_UNSPECIFIED;
        case UpAxis::x:
            return v1::UP_AXIS_X;
        case UpAxis::y:
            return v1::UP_AXIS_Y;
        case UpAxis::z:
            return v1::UP_AXIS_Z;
    }
    return v1::UP_AXIS_UNSPECIFIED;
}

}  // namespace

v1::SessionDescription to_wire(const SessionDescription& description) {
    description::require_name(description.name);
    description::require_length_unit(description.length_unit);
    v1::SessionDescription wire;
    wire.set_name(description.name);
    wire.set_up_axis(to_wire(description.up_axis));
    wire.set_length_unit(description.length_unit);
    return wire;
}

SessionDescription from_wire(const v1::SessionDescription& wire) {
    SessionDescription description;
    description.name = wire.name();
    description.length_unit = wire.length_unit();
    if (wire.up_axis() == v1::UP_AXIS_X) description.up_axis = UpAxis::x;
    if (wire.up_axis() == v1::UP_AXIS_Y) description.up_axis = UpAxis::y;
    if (wire.up_axis() == v1::UP_AXIS_Z) description.up_axis = UpAxis::z;
    return description;
}

}  // namespace meniscus::client
