// The description of a session, to and from the wire and files.
#pragma once

#include "meniscus/client/session_info.hpp"
#include "meniscus/v1/session_service.pb.h"

namespace meniscus::client {

/// Throws InvalidInput for a name or a unit that no session has: protobuf would send what is not UTF-8, and the server
/// could only say that the message is none.
v1::SessionDescription to_wire(const SessionDescription& description);
SessionDescription from_wire(const v1::SessionDescription& wire);

}  // namespace meniscus::client
