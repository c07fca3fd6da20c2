// A frame's particles on their way to the device: straight from where they are if that is pinned, else through memory
// that is; or from another place on the device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>

#include "engine/cuda/pinned_memory.hpp"
#include "engine/cuda/state.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/placed_frame.hpp"

namespace meniscus::cuda {

class Upload {
public:
    explicit Upload(const std::shared_ptr<MemoryAccount>& account) : staging_(account), input_(account) {
        input_.reserve(sizeof(FrameInput));
    }

    /// The last upload must have ended. Positions travel as they are given, and are widened on the device. The frame's
    /// arrays may be read until this one has ended.
    void start(const PlacedFrame& placed, const State& state, cudaStream_t stream) {
        const ParticleFrame& particles = placed.frame;
        const auto positions =
            particles.is_quantized() ? std::as_bytes(particles.quantized) : std::as_bytes(particles.positions);
        const auto levels = std::as_bytes(particles.levels);
        const auto goes_straight = [&](std::span<const std::byte> array) {
            return placed.on_device || is_pinned(array.data(), array.size());
        };
        std::size_t staged = 0;
        const auto add_staged = [&](std::span<const std::byte> array) {
            if (!goes_straight(array)) staged += array.size();
        };
        add_staged(positions);
        add_staged(levels);
        for (const ParticleArray& array : particles.arrays) add_staged(array.data);
        staging_.reserve(staged);
        std::byte* staging = staging_.get();
        const cudaMemcpyKind kind = placed.on_device ? cudaMemcpyDeviceToDevice : cudaMemcpyHostToDevice;
        const auto send_next = [&](std::span<const std::byte> from, std::byte* to) {
            if (goes_straight(from)) {
                copy(from, to, kind, stream);
                return;
            }
            send(from, staging, to, stream);
            staging += from.size();
        };
        send_next(positions, state.upload);
        send_next(levels, state.upload_levels());

        auto& input = *new (input_.get()) FrameInput;
        input.particles = static_cast<std::uint32_t>(particles.count());
        input.positions = positions_view(particles, state.settings.units_per_length);
        if (particles.is_quantized())
            input.positions.quantized = reinterpret_cast<const std::uint16_t*>(state.upload);
        else
            input.positions.positions = reinterpret_cast<const float*>(state.upload);
        if (!particles.levels.empty()) input.levels = reinterpret_cast<const std::uint8_t*>(state.upload_levels());
        input.attributes = placed.attributes;
        input.payload = payload_view(particles);
        std::byte* to = state.upload_payload();
        for (std::size_t i = 0; i < particles.arrays.size(); ++i) {
            send_next(particles.arrays[i].data, to);
            input.payload.data[i] = to;
            to += particles.arrays[i].data.size();
        }
        check(cudaMemcpyAsync(state.input, &input, sizeof(FrameInput), cudaMemcpyHostToDevice, stream),
              "cudaMemcpyAsync");
    }

private:
    static void copy(std::span<const std::byte> from, std::byte* to, cudaMemcpyKind kind, cudaStream_t stream) {
        if (from.empty()) return;
        check(cudaMemcpyAsync(to, from.data(), from.size(), kind, stream), "cudaMemcpyAsync");
    }
    /// Piece by piece: the device fetches one while the next is being copied.
    static void send(std::span<const std::byte> from, std::byte* staging, std::byte* to, cudaStream_t stream) {
        constexpr std::size_t piece = std::size_t{1} << 20;
        for (std::size_t at = 0; at < from.size(); at += piece) {
            const std::size_t bytes = std::min(piece, from.size() - at);
            std::memcpy(staging + at, from.data() + at, bytes);
            check(cudaMemcpyAsync(to + at, staging + at, bytes, cudaMemcpyHostToDevice, stream), "cudaMemcpyAsync");
        }
    }

    PinnedMemory staging_;
    PinnedMemory input_;
};

}  // namespace meniscus::cuda
