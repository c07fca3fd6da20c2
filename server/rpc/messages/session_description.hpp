// The description of a session, from the wire.
#pragma once

#include "meniscus/v1/session_service.pb.h"

namespace meniscus::server {

/// Without fields that this version does not know: they would be kept, listed and recorded unseen. Throws InvalidInput
/// for a name, a unit or an axis that no session has.
v1::SessionDescription checked_description(const v1::SessionDescription& wire);

}  // namespace meniscus::server
