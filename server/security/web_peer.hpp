// How a call through the HTTP port names its caller to its handler.
#pragma once

namespace meniscus::server {

/// Metadata of calls within the process, with the browser's address as gRPC writes those of its own peers. Other calls
/// may have it, too, and mean nothing.
inline constexpr const char* web_peer_key = "x-web-peer";

/// Metadata of any call, as the client or a proxy before the server has set them: the client for which the connection's
/// other end speaks. It deserves no more trust than that end.
inline constexpr const char* forwarded_for_key = "x-forwarded-for";

}  // namespace meniscus::server
