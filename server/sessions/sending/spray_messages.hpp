// A frame's spray as it goes out, to receivers that ask for it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "meniscus/mesh.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

std::vector<SharedMessage> spray_messages(std::span<const Point> points);

/// Whether a serialized StreamResponse or WatchResponse is one of these.
bool is_spray(std::string_view message);

}  // namespace meniscus::server
