// ServerService.GetServerInfo.
#pragma once

#include "meniscus/reconstructor.hpp"
#include "meniscus/v1/server_service.pb.h"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

v1::GetServerInfoResponse get_server_info(const BackendDescription& backend, unsigned threads, const Limits& limits,
                                          bool publishes);

}  // namespace meniscus::server
