// A stream as a session sees it, played by a test.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/reconstructor.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "opened_upload.hpp"
#include "sessions/session/session.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {

inline constexpr const char* id = "00000000-0000-4000-8000-000000000000";

/// Plays a stream: one thread uploads, another reads.
struct Simulator {
    /// woken: called in the session's thread when there are messages again.
    Simulator(
        Session& s, const UploadOptions& options, std::function<void()> woken = [] {})
        : session(s),
          upload(test::open_upload(
              session, options,
              [awake = awake, woken = std::move(woken)](std::size_t /*part*/) {
                  awake->release();
                  woken();
              },
              [this] { ++drained; })) {}

    void send(std::uint64_t index, const Particles& particles) {
        std::promise<InputFrame*> lent;
        session.request_input([&](InputFrame& input) {
            lent.set_value(&input);
            return true;
        });
        InputFrame& input = *lent.get_future().get();
        input.index = index;
        input.simulation_time = 0.0;
        input.quantized = false;
        input.has_levels = false;
        input.particle_count = particles.positions.size() / 3;
        input.allocate(particles.positions.size() * sizeof(float));
        if (!particles.positions.empty())
            std::memcpy(input.bytes.data(), particles.positions.data(), input.bytes.size());
        input.received_at = std::chrono::steady_clock::now();
        session.submit(upload, input);
    }
    void end() { session.end_upload(upload, nullptr); }

    /// The next message, or none at the end.
    std::optional<v1::StreamResponse> receive() {
        for (;;) {
            auto next = upload->output.take();
            if (const auto* message = std::get_if<SharedMessage>(&next)) {
                v1::StreamResponse response;
                EXPECT_TRUE(response.ParseFromString(**message));
                return response;
            }
            if (const auto* end = std::get_if<OutputQueue::End>(&next)) {
                error = end->error;
                return std::nullopt;
            }
            awake->acquire();
        }
    }
    /// Indices of the frames that are answered until the end.
    std::vector<std::uint64_t> receive_all() {
        std::vector<std::uint64_t> indices;
        while (const auto response = receive())
            if (response->has_frame_statistics()) indices.push_back(response->frame_statistics().frame_index());
        return indices;
    }

    /// The messages to the stream, in order: "7" for an answer, "-7 replaced" or "-7 not nth" for a dropped frame,
    /// "draining".
    std::vector<std::string> receive_story() {
        std::vector<std::string> story;
        while (const auto response = receive()) {
            if (response->has_frame_statistics())
                story.push_back(std::to_string(response->frame_statistics().frame_index()));
            if (response->has_draining()) story.emplace_back("draining");
            if (!response->has_frame_dropped()) continue;
            const v1::FrameDropped& dropped = response->frame_dropped();
            story.push_back(fmt::format("-{} {}", dropped.frame_index(),
                                        dropped.reason() == v1::DROP_REASON_REPLACED ? "replaced" : "not nth"));
        }
        return story;
    }

    Session& session;
    /// Shared, as the session may outlive its simulators.
    const std::shared_ptr<std::counting_semaphore<>> awake = std::make_shared<std::counting_semaphore<>>(0);
    std::atomic<int> drained{0};
    std::shared_ptr<Upload> upload;
    std::exception_ptr error;
};

inline decltype(ReconstructFunctions::reconstruct) reconstruct_on_the_cpu() {
    return [reconstructor =
                std::make_shared<Reconstructor>(settings(), BackendOptions{.threads = 2, .keep_lattice = true})](
               const ParticleFrame& frame, Mesh& mesh) {
        reconstructor->reconstruct(frame, mesh);
        return reconstructor->statistics();
    };
}

}  // namespace meniscus::server::test
