// Whether an HTTP client can decompress gzip.
#pragma once

#include <string_view>

namespace meniscus::server {

/// accept_encoding: the header's value, as "br, gzip;q=0.8"; empty: none was sent.
bool accepts_gzip(std::string_view accept_encoding);

}  // namespace meniscus::server
