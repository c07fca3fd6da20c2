// Certificates, keys and tokens are read whole.
#pragma once

#include <string>

namespace meniscus::server {

/// Throws InvalidInput if it is no regular file, cannot be read or has more than 1 MiB. Never waits for a writer.
std::string read_small_file(const std::string& path);

/// Throws InvalidInput if users other than the file's owner and group may read or write it.
void require_private(const std::string& path);

}  // namespace meniscus::server
