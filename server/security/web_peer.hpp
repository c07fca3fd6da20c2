// How a call through the HTTP port tells its handler who has made it.
#pragma once

namespace meniscus::server {

/// Metadata of calls within the process, with the browser's address as gRPC writes those of its own peers. Other calls
/// may have it, too, and mean nothing.
inline constexpr const char* web_peer_key = "x-web-peer";

/// Metadata of any call, as the client or a proxy before the server has set them: for whom the connection's other end
/// speaks. Worth what that end is worth.
inline constexpr const char* forwarded_for_key = "x-forwarded-for";

}  // namespace meniscus::server
