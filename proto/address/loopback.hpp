// Which addresses, as server and client take them, cannot be reached from another machine.
#pragma once

#include <string_view>

namespace meniscus::address {

/// Whether the address is "unix:PATH", or its host is "localhost", 127.0.0.0/8 or [::1]. Other names are not looked up.
bool is_loopback(std::string_view address);

}  // namespace meniscus::address
