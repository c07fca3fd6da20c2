// The resources that a server's sessions share.
#pragma once

#include <memory>

#include "meniscus/memory.hpp"
#include "sessions/handover/timer.hpp"
#include "sessions/handover/turns.hpp"
#include "sessions/handover/worker_pool.hpp"
#include "sessions/limits/bytes_in_flight.hpp"
#include "sessions/sending/metrics.hpp"

namespace meniscus::server {

struct SharedResources {
    std::shared_ptr<WorkerPool> workers;  ///< encode
    std::shared_ptr<Metrics> metrics = std::make_shared<Metrics>();
    std::shared_ptr<Turns> turns = std::make_shared<Turns>();  ///< on the device that the session reconstructs on
    /// The memory of all sessions' reconstructions, of their encoding, and of the frames that they keep; may be none.
    std::shared_ptr<SharedMemory> memory{};
    /// The pages that the session's device copies from and to by itself; none: it copies none.
    std::shared_ptr<PagePinning> pinning{};
    std::shared_ptr<BytesInFlight> bytes_in_flight = std::make_shared<BytesInFlight>();
    std::shared_ptr<Timer> deadlines = std::make_shared<Timer>();  ///< of frames on the device
};

}  // namespace meniscus::server
