// The session's id: in the message, and in the metadata that proxies route by.
#pragma once

#include <grpcpp/server_context.h>

#include <string>
#include <string_view>

namespace meniscus::server {

/// A UUID in canonical form: 8-4-4-4-12 lower-case hexadecimal digits.
bool is_session_id(std::string_view text);

/// The id in the call's metadata. Throws InvalidInput unless it is there once, and a UUID.
std::string metadata_session_id(const grpc::ServerContextBase& context);

/// Throws InvalidInput unless the message's id is the metadata's.
void require_same_session(std::string_view metadata, std::string_view message);

}  // namespace meniscus::server
