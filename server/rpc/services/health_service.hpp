// grpc.health.v1: whether the server takes calls.
//
// Everybody may ask, so nothing of the request is received: it could have any size. The answer is that of the server as
// a whole, whatever service is asked about.
#pragma once

#include <mutex>
#include <set>

#include "rpc/calls/byte_service.hpp"

namespace meniscus::server {

/// Thread-safe. Takes no calls at first.
class HealthService final : public ByteService {
public:
    HealthService();

    void set_serving(bool serving);

private:
    class WatchReactor;

    std::mutex mutex_;  ///< for what follows, and the watches
    bool serving_ = false;
    std::set<WatchReactor*> watches_;
};

}  // namespace meniscus::server
