// Where frames' particles lie on the device: two areas, so that one frame can be sent while another is reconstructed.
//
// An area is free, or has a frame that was sent ahead, or the one that is reconstructed. The kernels' stream waits for
// the copies of a frame that was sent ahead; the host waits for the kernels before their area is written again. A
// second area is taken once a frame is sent ahead, and given up where there is no memory for the rest.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/cuda/array_memory.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "engine/cuda/stream.hpp"
#include "engine/growth.hpp"
#include "meniscus/error.hpp"
#include "meniscus/frame_upload.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/frame_sender.hpp"

namespace meniscus::cuda {

/// A frame's arrays, in the order in which they lie in an area: positions, levels, and the others.
using FrameArrays = std::vector<std::span<const std::byte>>;
inline FrameArrays arrays_of(const ParticleFrame& frame) {
    FrameArrays arrays{frame.is_quantized() ? std::as_bytes(frame.quantized) : std::as_bytes(frame.positions),
                       std::as_bytes(frame.levels)};
    for (const ParticleArray& array : frame.arrays) arrays.push_back(array.data);
    return arrays;
}
/// Bytes that an array takes of an area.
inline std::size_t room_for(std::span<const std::byte> array) {
    constexpr std::size_t alignment = 16;
    return (array.size() + alignment - 1) / alignment * alignment;
}
/// Bytes that all arrays of a frame take; never 0.
inline std::size_t room_for(const FrameArrays& arrays) {
    std::size_t bytes = 0;
    for (const auto& array : arrays) bytes += room_for(array);
    return std::max<std::size_t>(bytes, 1);
}

/// send() and withdraw() are for any thread, until the end; all other calls for the thread that reconstructs.
class UploadAreas final : public FrameSender {
    struct Area {
        Area(int device, cudaStream_t stream, const std::shared_ptr<MemoryAccount>& account)
            : memory(device, stream, account) {}
        /// The area in the form that ArrayMemory takes.
        auto array() {
            return [this](auto& take) { take("upload", begin, bytes); };
        }

        ArrayMemory memory;
        std::byte* begin = nullptr;
        std::size_t bytes = 0;
        AwaitedEvent arrived;     ///< event after the copies of the frame that was sent ahead
        std::uint64_t ahead = 0;  ///< number of that frame; 0: none was sent
        FrameArrays arrays;       ///< arrays of that frame
        bool is_in_use = false;   ///< whether the frame that is reconstructed lies here
    };

public:
    /// The area of the frame that is reconstructed.
    struct Place {
        std::byte* begin = nullptr;
        bool is_filled =
            false;  ///< whether the frame is there, or will be by copies that the kernels' stream waits for
    };

    UploadAreas(int device, const std::shared_ptr<MemoryAccount>& device_account)
        : device_(device), areas_{{{device, stream_.get(), device_account}, {device, stream_.get(), device_account}}} {}
    ~UploadAreas() override {
        try {
            at_end_.emplace(device_);
        } catch (...) {
            // The device is lost: there is nothing to free on it.
        }
    }

    std::uint64_t send(const ParticleFrame& frame) noexcept override {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        // The thread that reconstructs may take memory now, which can be long.
        if (!lock || is_closed_) return 0;
        try {
            const FrameArrays arrays = arrays_of(frame);
            const CurrentDevice current(device_);
            for (const auto& array : arrays)
                if (!array.empty() && !is_pinned(array.data(), array.size())) return 0;
            // Only now: a second area for frames that are never sent would be memory for nothing.
            has_senders_ = true;
            Area* const area = free_area(room_for(arrays));
            if (area == nullptr || has_frame_ahead()) return 0;
            copy_ahead(*area, arrays);
            area->arrays = arrays;
            return area->ahead = ++last_sent_;
        } catch (...) {
            // The frame's reconstruction meets the same refusal, and throws.
            stream_.settle();
            return 0;
        }
    }

    void withdraw(std::uint64_t number) noexcept override {
        const std::lock_guard lock(mutex_);
        for (Area& area : areas_)
            if (number != 0 && area.ahead == number) withdraw(area);
    }

    /// The place of a frame, until give_back(). ahead: its number, 0 if it was not sent. kernels: made to wait for its
    /// copies. Throws as DeviceMemory does.
    Place take(const FrameArrays& arrays, std::uint64_t ahead, Stream& kernels) {
        const std::lock_guard lock(mutex_);
        for (Area& area : areas_) {
            if (ahead == 0 || area.ahead != ahead) continue;
            if (!are_the_same(area.arrays, arrays)) {
                withdraw(area);
                continue;
            }
            area.arrived.hold_up(kernels.get());
            area.ahead = 0;
            area.is_in_use = true;
            return {area.begin, true};
        }
        Area& area = grown_area(room_for(arrays));
        area.is_in_use = true;
        area.memory.poison(area.array());
        add_second_area(area.bytes);
        return {area.begin, false};
    }
    /// Frees the area once the frame's work has ended.
    void give_back() noexcept {
        const std::lock_guard lock(mutex_);
        for (Area& area : areas_) area.is_in_use = false;
    }
    /// See ArrayMemory.
    void require_whole_guards() {
        const std::lock_guard lock(mutex_);
        for (Area& area : areas_)
            if (area.is_in_use) area.memory.require_whole_guards(area.array());
    }

    /// Allocates other memory; where there is none left, gives up the area that is not in use. The frame that it may
    /// have is sent once more when it is reconstructed.
    template <class Allocate>
    void with_room(const Allocate& allocate) {
        try {
            allocate();
        } catch (const LimitExceeded&) {
            if (!release_spare_area()) throw;
            allocate();
        }
    }

    /// When the reconstruction ends: nothing is sent from here on, and no memory is kept on the device.
    void close() noexcept {
        const std::lock_guard lock(mutex_);
        is_closed_ = true;
        stream_.settle();
        for (Area& area : areas_) {
            area.ahead = 0;
            area.memory.release();
        }
        stream_.settle();
    }

private:
    // With the lock held.

    bool has_frame_ahead() const { return areas_[0].ahead != 0 || areas_[1].ahead != 0; }
    Area* free_area(std::size_t bytes) {
        for (Area& area : areas_)
            if (area.ahead == 0 && !area.is_in_use && area.bytes >= bytes) return &area;
        return nullptr;
    }
    void copy_ahead(Area& area, const FrameArrays& arrays) {
        area.memory.poison(area.array());
        std::byte* to = area.begin;
        for (const auto& array : arrays) {
            if (!array.empty())
                check(cudaMemcpyAsync(to, array.data(), array.size(), cudaMemcpyHostToDevice, stream_.get()),
                      "cudaMemcpyAsync");
            to += room_for(array);
        }
        area.arrived.record(stream_.get());
    }
    void withdraw(Area& area) noexcept {
        if (std::exchange(area.ahead, 0) == 0) return;
        try {
            const CurrentDevice current(device_);
            stream_.settle();
        } catch (...) {
            // The device is lost, and copies nothing any more.
        }
    }
    static bool are_the_same(const FrameArrays& a, const FrameArrays& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
            return x.size() == y.size() && (x.empty() || x.data() == y.data());
        });
    }

    /// An area without a frame, of at least these bytes.
    Area& grown_area(std::size_t bytes) {
        if (Area* const area = free_area(bytes)) return *area;
        // At most one area has a frame that was sent ahead.
        Area& area = areas_[0].ahead == 0 ? areas_[0] : areas_[1];
        try {
            assign(area, with_room_to_grow(bytes));
        } catch (const LimitExceeded&) {
            if (!release(&area == &areas_[0] ? areas_[1] : areas_[0])) throw;
            assign(area, with_room_to_grow(bytes));
        }
        was_refused_ = false;
        return area;
    }
    /// Takes a second area unless it was refused: then every frame would try in vain until the sizes change.
    void add_second_area(std::size_t bytes) {
        if (!has_senders_ || was_refused_) return;
        for (Area& area : areas_) {
            if (area.is_in_use || area.ahead != 0 || area.bytes >= bytes) continue;
            try {
                assign(area, bytes);
            } catch (const LimitExceeded&) {
                was_refused_ = true;
            }
        }
    }
    void assign(Area& area, std::size_t bytes) {
        release(area);
        area.bytes = bytes;
        try {
            area.memory.assign(area.array());
        } catch (...) {
            area.bytes = 0;
            throw;
        }
        // It is written on another stream, too.
        stream_.synchronize();
    }
    /// Returns whether there was memory to be released.
    bool release(Area& area) {
        if (area.bytes == 0) return false;
        withdraw(area);
        area.memory.release();
        area.bytes = 0;
        stream_.synchronize();
        return true;
    }
    bool release_spare_area() {
        const std::lock_guard lock(mutex_);
        bool released = false;
        for (Area& area : areas_)
            if (!area.is_in_use && release(area)) released = true;
        was_refused_ = was_refused_ || released;
        return released;
    }

    const int device_;
    std::optional<CurrentDevice> at_end_;  ///< makes the device current while the members below end, in any thread
    std::mutex mutex_;                     ///< guards the members below
    Stream stream_;                        ///< stream of the copies of frames that are sent ahead
    std::array<Area, 2> areas_;
    std::uint64_t last_sent_ = 0;
    bool has_senders_ = false;  ///< whether frames are sent ahead, and can be
    bool was_refused_ = false;  ///< whether there was no room for a second area of this size
    bool is_closed_ = false;
};

}  // namespace meniscus::cuda
