// How a call through the HTTP port tells its handler who has made it.
#pragma once

namespace meniscus::server {

/// Metadata of calls within the process, with the browser's address as gRPC writes those of its own peers. Other calls
/// may have it, too, and mean nothing.
inline constexpr const char* web_peer_key = "x-web-peer";

}  // namespace meniscus::server
