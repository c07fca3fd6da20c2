// One frame as received, of particles or of finished bricks, in a buffer that is reused.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/frame_upload.hpp"
#include "meniscus/memory.hpp"
#include "meniscus/particle_frame.hpp"
#include "sessions/intake/brick_part.hpp"
#include "sessions/intake/pinned_bytes.hpp"
#include "sessions/limits/bytes_in_flight.hpp"
#include "sessions/limits/retained_memory.hpp"

namespace meniscus::server {

struct InputFrame {
    /// An array beside positions and levels, of those that the session's settings name.
    struct KeptArray {
        std::string name;
        ElementType type = ElementType::float32;
        std::size_t components = 1;
        std::size_t offset = 0;  ///< in `bytes`, behind positions and levels; a multiple of size_of(type)
    };

    /// memory: counts what stays here between two frames; may be none. pinning: see pin(); may be none.
    explicit InputFrame(const std::shared_ptr<MemoryAccount>& account,
                        std::shared_ptr<BytesInFlight> all_sessions = std::make_shared<BytesInFlight>(),
                        std::shared_ptr<SessionInFlight> session = std::make_shared<SessionInFlight>(),
                        std::shared_ptr<SharedMemory> memory = nullptr, std::shared_ptr<PagePinning> pinning = nullptr)
        : bytes(AccountAllocator<std::byte>(account)),
          in_flight_(std::move(all_sessions), std::move(session)),
          retained_(std::move(memory)),
          pinned_(std::move(pinning)) {}

    /// Makes `bytes` of this size, which are announced for flight; keeps its memory if that suffices. Throws
    /// LimitExceeded or std::bad_alloc.
    void allocate(std::size_t size);
    /// See FrameInFlight.
    bool book(std::size_t arrived, std::function<void()> booked) { return in_flight_.book(arrived, std::move(booked)); }
    /// Lets the GPU that reconstructs the frame fetch its bytes by itself, once all have arrived; and those of the
    /// frames that follow in this memory.
    void pin() noexcept { pinned_.hold(std::span(bytes.data(), bytes.capacity())); }
    /// Sends the frame, which is complete, ahead of its reconstruction. send: see ReconstructFunctions::send_ahead.
    void send_ahead(const std::function<FrameUpload(const ParticleFrame& frame)>& send) { sent_ = send(view()); }
    /// Another handle of the frame that was sent ahead, to withdraw it by.
    FrameUpload sent() const { return sent_.another(); }
    /// Its bytes are no longer in flight. Its memory stays for the next frame, if there is room for it.
    void land() noexcept {
        sent_ = {};
        in_flight_.release();
        if (!retained_.hold(bytes.capacity())) free_memory();
    }
    void free_memory() noexcept {
        sent_ = {};
        pinned_.drop();
        Array<std::byte>(bytes.get_allocator()).swap(bytes);
        particle_count = 0;
        brick_parts.clear();
        keep_arrays({});
        shown_in_run.reset();
        retained_.drop();
    }
    /// Takes over the particles of a frame that has landed, whose bytes are then gone.
    void take_from(InputFrame& other) {
        index = other.index;
        simulation_time = other.simulation_time;
        particle_count = std::exchange(other.particle_count, 0);
        quantized = other.quantized;
        has_levels = other.has_levels;
        quantization_box = other.quantization_box;
        sent_ = {};
        pinned_.drop();
        other.pinned_.drop();
        // Its allocator stays, with its account.
        Array<std::byte> taken(other.bytes.get_allocator());
        taken.swap(other.bytes);
        bytes = std::move(taken);  // the memory that the arrays lie in
        arrays_ = std::exchange(other.arrays_, {});
        array_views_ = std::exchange(other.array_views_, {});
        retained_ = std::move(other.retained_);
        received_at = other.received_at;
        shown_in_run = std::exchange(other.shown_in_run, std::nullopt);
    }
    /// After allocate(), which forgets those of the frame before; particle_count is set.
    void keep_arrays(std::vector<KeptArray> arrays);
    /// The particles, in place.
    ParticleFrame view() const;
    /// The bytes of positions and levels, which come first.
    std::size_t particle_bytes() const;

    std::uint64_t index = 0;
    double simulation_time = 0.0;
    std::size_t particle_count = 0;
    bool quantized = false;
    bool has_levels = false;
    Box quantization_box;
    /// Of a frame of bricks what its publishers say, by part; empty for one of particles, from allocate() on.
    std::vector<BrickPart> brick_parts;
    /// All positions, then all levels, then the arrays; or the messages of each part.
    Array<std::byte> bytes;
    std::chrono::steady_clock::time_point received_at;
    /// The run's number, once the session has shown these particles; none again from allocate() on.
    std::optional<std::uint64_t> shown_in_run;

private:
    std::vector<KeptArray> arrays_;
    std::vector<ParticleArray> array_views_;  ///< of them
    FrameInFlight in_flight_;
    RetainedMemory retained_;
    PinnedBytes pinned_;  ///< ends before `bytes`
    FrameUpload sent_;    ///< ends before `pinned_`
};

}  // namespace meniscus::server
