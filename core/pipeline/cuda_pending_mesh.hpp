// One mesh on its way to the host.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "pipeline/cuda_mesh_storage.hpp"
#include "pipeline/cuda_packed_bricks.hpp"

namespace meniscus::cuda {

/// Vertices come down whole, since bricks share them; then triangles, some bricks at a time; or nothing of both, where
/// bricks are packed. Nothing is on its way between two calls.
class PendingMesh final : public MeshDownload::Source {
    /// Work with the device. Its exception is thrown again by every later call.
    template <class Work>
    auto guarded(const Work& work) {
        const CopyTime::Span span(*time_);
        try {
            const CurrentDevice current(storage_->device);
            return work();
        } catch (const LimitExceeded& error) {
            // This is no limit of the frame, which has been made.
            fail(std::make_exception_ptr(DeviceError("the download of a mesh", error.what(), storage_->device)));
        } catch (...) {
            fail(std::current_exception());
        }
    }

public:
    /// `to` has the mesh's sizes, and room for all `bricks`, those without triangles included.
    PendingMesh(std::shared_ptr<MeshStorage> storage, const MeshOnDevice& from, Mesh& to)
        : storage_(std::move(storage)), from_(from), to_(to) {}

    void start() override { bring_first(0); }
    void bring(std::size_t brick) override {
        // A brick that has arrived is served without the lock.
        if (arrived_ <= brick) bring_first(brick + 1);
    }
    void finish() override { bring_first(std::numeric_limits<std::size_t>::max()); }
    std::shared_ptr<PackedBricks> pack(const CodingOptions& options) override {
        try {
            return packed(options);
        } catch (const LimitExceeded&) {
            return nullptr;  // the mesh itself needs no more than it has
        }
    }
    /// The same; throws LimitExceeded where there is too little memory.
    std::shared_ptr<DevicePackedBricks> packed(const CodingOptions& options) {
        const std::lock_guard lock(storage_->copying);
        if (error_) std::rethrow_exception(error_);
        if (done_ || !keeps_lattice()) return nullptr;
        std::exception_ptr no_room;
        auto bricks = guarded([&]() -> std::shared_ptr<DevicePackedBricks> {
            list_bricks();
            try {
                return std::make_shared<DevicePackedBricks>(storage_, from_, to_, on_device_, options, time_);
            } catch (const LimitExceeded&) {
                no_room = std::current_exception();
                return nullptr;
            }
        });
        if (no_room) std::rethrow_exception(no_room);
        return bricks;
    }
    std::vector<AttributeRange> attribute_ranges() override {
        const std::lock_guard lock(storage_->copying);
        if (error_) std::rethrow_exception(error_);
        if (started_ || done_) return meniscus::attribute_ranges(to_);
        return guarded([&] { return ranges_on_device(); });
    }
    void abandon() noexcept override {
        const std::lock_guard lock(storage_->copying);
        done_ = true;
    }
    double seconds() const override {
        const std::lock_guard lock(storage_->copying);
        return time_->seconds;
    }

    /// Whether the arrays on the device may be written again.
    bool is_done() const { return done_; }

private:
    /// Bytes of triangles in a step: few enough at first for the first brick to be there soon, then twice as many from
    /// step to step, until the copies take much longer than the waits between them.
    static constexpr std::size_t first_fetch_bytes = std::size_t{256} << 10;
    static constexpr std::size_t most_fetch_bytes = std::size_t{4} << 20;

    /// Brings the vertices, and the triangles of this number of bricks, at most all. Other threads take their turns
    /// between the steps.
    void bring_first(std::size_t bricks) {
        while (!step(bricks)) {
        }
    }

    /// Returns whether nothing is left to bring.
    bool step(std::size_t bricks) {
        const std::lock_guard lock(storage_->copying);
        if (error_) std::rethrow_exception(error_);
        if (done_ || (started_ && arrived_ >= bricks)) return true;
        guarded([&] {
            if (std::exchange(started_, true))
                fetch_bricks();
            else
                fetch_vertices();
            done_ = arrived_ == to_.bricks.size();
        });
        return done_ || arrived_ >= bricks;
    }

    [[noreturn]] void fail(const std::exception_ptr& error) {
        error_ = error;
        arrived_ = 0;
        storage_->download.forget(storage_->stream);
        done_ = true;
        std::rethrow_exception(error);
    }

    bool keeps_lattice() const { return from_.lattice.bricks != nullptr; }

    /// Brings the bricks, of which those with triangles stay.
    void list_bricks() {
        if (std::exchange(has_bricks_, true)) return;
        std::vector<KeptBrick> kept(keeps_lattice() ? to_.bricks.size() : 0);
        fetch(from_.bricks, to_.bricks.size(), to_.bricks.data());
        fetch(from_.lattice.bricks, kept.size(), kept.data());
        storage_->download.finish(storage_->stream);
        for (std::uint32_t b = 0; b < kept.size(); ++b)
            if (to_.bricks[b].triangle_count() != 0) on_device_.push_back({.index = b, .kept = kept[b]});
        std::erase_if(to_.bricks, [](const MeshBrick& brick) { return brick.triangle_count() == 0; });
    }

    void fetch_vertices() {
        list_bricks();
        fetch(from_.mesh.vertices, to_.vertices.size(), to_.vertices.data());
        fetch(from_.mesh.normals, to_.normals.size(), to_.normals.data());
        for (std::size_t a = 0; a < to_.attributes.size() && !to_.vertices.empty(); ++a)
            fetch(static_cast<const std::byte*>(from_.mesh.attributes[a].data), to_.attributes[a].data.size(),
                  to_.attributes[a].data.data());
        fetch(from_.lattice.blocks, to_.lattice.blocks.size(), to_.lattice.blocks.data());
        to_.lattice.bricks.clear();
        for (const BrickOnDevice& brick : on_device_)
            to_.lattice.bricks.push_back({.first = brick.kept.first, .count = brick.kept.blocks});
        storage_->download.finish(storage_->stream);
    }

    std::vector<AttributeRange> ranges_on_device() {
        std::vector<AttributeRange> ranges;
        if (from_.mesh.vertex_count == 0 || to_.attributes.empty()) return ranges;
        auto memory = storage_->packing_memory();
        cudaStream_t stream = storage_->stream.get();
        const std::size_t bytes = to_.attributes.size() * sizeof(AttributeExtremes);
        memory->reserve(0, 0);
        check(cudaMemsetAsync(memory->extremes, 0, bytes, stream), "cudaMemsetAsync");
        for (std::size_t a = 0; a < to_.attributes.size(); ++a) {
            const MeshAttribute& attribute = to_.attributes[a];
            find_extremes(static_cast<const std::byte*>(from_.mesh.attributes[a].data), attribute.type,
                          from_.mesh.vertex_count, attribute.components, memory->extremes + a, storage_->launch);
        }
        auto* const extremes = memory->table<AttributeExtremes>();
        check(cudaMemcpyAsync(extremes, memory->extremes, bytes, cudaMemcpyDeviceToHost, stream), "cudaMemcpyAsync");
        storage_->stream.synchronize();
        for (std::size_t a = 0; a < to_.attributes.size(); ++a)
            ranges.push_back(extremes[a].range(to_.attributes[a].type, to_.attributes[a].components));
        storage_->to_pack_in.push_back(std::move(memory));
        return ranges;
    }

    void fetch_bricks() {
        const std::size_t begin = arrived_;
        std::size_t end = begin;
        for (std::size_t triangles = 0; end < to_.bricks.size() && triangles * sizeof(Triangle) < fetch_bytes_; ++end)
            triangles += to_.bricks[end].triangle_count();
        // Within a level, the triangles of successive bricks follow one another.
        for (std::size_t level = 0; level < triangle_level_count; ++level) {
            const std::uint32_t first = to_.bricks[begin].ranges[level].first;
            const TriangleRange& last = to_.bricks[end - 1].ranges[level];
            fetch(from_.mesh.triangles + first, last.first + last.count - first, to_.triangles.data() + first);
        }
        storage_->download.finish(storage_->stream);
        arrived_ = end;
        fetch_bytes_ = std::min(2 * fetch_bytes_, most_fetch_bytes);
    }

    template <class T>
    void fetch(const T* from, std::size_t count, T* to) {
        storage_->download.fetch(from, count, to, storage_->stream.get());
    }

    const std::shared_ptr<MeshStorage> storage_;
    const MeshOnDevice from_;
    Mesh& to_;
    const std::shared_ptr<CopyTime> time_ = std::make_shared<CopyTime>();
    std::atomic<bool> done_{false};
    std::atomic<std::size_t> arrived_{0};  ///< number of bricks whose triangles are there; 0 after a failure
    // Members that storage_->copying guards:
    bool has_bricks_ = false;
    bool started_ = false;
    std::vector<BrickOnDevice> on_device_;  ///< of to_.bricks, where the lattice is kept
    std::exception_ptr error_;
    std::size_t fetch_bytes_ = first_fetch_bytes;
};

}  // namespace meniscus::cuda
