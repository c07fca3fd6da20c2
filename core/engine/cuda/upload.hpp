// A frame's particles on their way to the device: straight from their place if that is pinned, else through pinned
// memory; or from another place on the device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "engine/cuda/pinned_memory.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/upload_areas.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/placed_frame.hpp"

namespace meniscus::cuda {

class Upload {
public:
    explicit Upload(const std::shared_ptr<MemoryAccount>& account) : staging_(account), input_(account) {
        input_.reserve(sizeof(FrameInput));
    }

    /// The last upload must have ended. Positions travel as they are given, and are widened on the device. The arrays
    /// may be read until this upload has ended.
    void send_particles(const FrameArrays& arrays, bool on_device, std::byte* area, cudaStream_t stream) {
        // First, so that the device fetches these while the others are staged.
        staged_.clear();
        std::size_t bytes = 0;
        for (const auto& array : arrays) {
            if (on_device) {
                copy_on_device(array, area, stream);
            } else if (!copy_straight(area, array.data(), array.size(), cudaMemcpyHostToDevice, stream)) {
                staged_.push_back({array, area});
                bytes += array.size();
            }
            area += room_for(array);
        }
        staging_.reserve(bytes);
        std::byte* staging = staging_.get();
        for (const Staged& each : staged_) {
            send(each.array, staging, each.to, stream);
            staging += each.array.size();
        }
    }

    /// Sends the kernels the description of a frame whose arrays lie in this area, or are on their way.
    void send_input(const PlacedFrame& placed, const FrameArrays& arrays, const std::byte* area, const State& state,
                    cudaStream_t stream) {
        const ParticleFrame& particles = placed.frame;
        auto& input = *new (input_.get()) FrameInput;
        input.particles = static_cast<std::uint32_t>(particles.count());
        input.positions = positions_view(particles, state.settings.units_per_length);
        if (particles.is_quantized())
            input.positions.quantized = reinterpret_cast<const std::uint16_t*>(area);
        else
            input.positions.positions = reinterpret_cast<const float*>(area);
        area += room_for(arrays[0]);
        if (!particles.levels.empty()) input.levels = reinterpret_cast<const std::uint8_t*>(area);
        area += room_for(arrays[1]);
        input.attributes = placed.attributes;
        input.payload = payload_view(particles);
        for (std::size_t i = 0; i < particles.arrays.size(); ++i) {
            input.payload.data[i] = area;
            area += room_for(particles.arrays[i].data);
        }
        check(cudaMemcpyAsync(state.input, &input, sizeof(FrameInput), cudaMemcpyHostToDevice, stream),
              "cudaMemcpyAsync");
    }

private:
    struct Staged {
        std::span<const std::byte> array;
        std::byte* to;
    };

    static void copy_on_device(std::span<const std::byte> from, std::byte* to, cudaStream_t stream) {
        if (from.empty()) return;
        check(cudaMemcpyAsync(to, from.data(), from.size(), cudaMemcpyDeviceToDevice, stream), "cudaMemcpyAsync");
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

    std::vector<Staged> staged_;  ///< arrays of the frame that go through `staging_`
    PinnedMemory staging_;
    PinnedMemory input_;
};

}  // namespace meniscus::cuda
