// A session whose reconstructions wait for the test.
#pragma once

#include <atomic>
#include <memory>
#include <semaphore>
#include <thread>

#include "simulator_player.hpp"

namespace meniscus::server::test {

struct GatedSession {
    ~GatedSession() { gate.release(1000); }

    /// Until this number of reconstructions has begun.
    void wait_for_begun(int count) const {
        while (begun < count) std::this_thread::yield();
    }

    std::counting_semaphore<> gate{0};  ///< one reconstruction for each
    std::atomic<int> begun{0};
    Session session{{.id = id},
                    settings(),
                    Limits{},
                    {.reconstruct =
                         [this, cpu = reconstruct_on_the_cpu()](const ParticleFrame& frame, Mesh& mesh) {
                             ++begun;
                             gate.acquire();
                             return cpu(frame, mesh);
                         }},
                    {.workers = std::make_shared<WorkerPool>(1)}};
    const Particles particles = wave(4, 0.0);
};

}  // namespace meniscus::server::test
