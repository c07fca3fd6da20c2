// The methods that the server has, by their paths: the labels of metrics, of which strangers cannot make more.
#pragma once

#include <string_view>

#include "sessions/sending/metrics.hpp"

namespace meniscus::server {

/// path: as "/meniscus.v1.SurfaceService/Watch". One method, named "unknown", for all paths of no method; it and the
/// others last as long as the program.
const Metrics::Method& known_method(std::string_view path);

}  // namespace meniscus::server
