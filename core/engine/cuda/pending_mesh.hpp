// One mesh on its way to the host.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "engine/cuda/mesh_storage.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"

namespace meniscus::cuda {

/// Vertices come down whole, since bricks share them; then triangles, some bricks at a time. Nothing is on its way
/// between two calls.
class PendingMesh final : public MeshDownload::Source {
public:
    /// `to` has the mesh's sizes, and room for all `bricks`, those without triangles included.
    PendingMesh(std::shared_ptr<MeshStorage> storage, const DeviceMesh& from, const MeshBrick* bricks, Mesh& to)
        : storage_(std::move(storage)), from_(from), bricks_(bricks), to_(to) {}

    void start() override { bring_first(0); }
    void bring(std::size_t brick) override {
        // A brick that has arrived is served without the lock.
        if (arrived_ <= brick) bring_first(brick + 1);
    }
    void finish() override { bring_first(std::numeric_limits<std::size_t>::max()); }
    void abandon() noexcept override {
        const std::lock_guard lock(storage_->copying);
        done_ = true;
    }
    double seconds() const override {
        const std::lock_guard lock(storage_->copying);
        return seconds_;
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
        const auto start = std::chrono::steady_clock::now();
        try {
            const CurrentDevice current(storage_->device);
            if (std::exchange(started_, true))
                fetch_bricks();
            else
                fetch_vertices();
            done_ = arrived_ == to_.bricks.size();
        } catch (const LimitExceeded& error) {
            // This is no limit of the frame, which has been made.
            fail(std::make_exception_ptr(DeviceError("the download of a mesh", error.what(), storage_->device)));
        } catch (...) {
            fail(std::current_exception());
        }
        seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return done_ || arrived_ >= bricks;
    }

    [[noreturn]] void fail(const std::exception_ptr& error) {
        error_ = error;
        arrived_ = 0;
        storage_->download.forget(storage_->stream);
        done_ = true;
        std::rethrow_exception(error);
    }

    void fetch_vertices() {
        fetch(bricks_, to_.bricks.size(), to_.bricks.data());
        fetch(from_.vertices, to_.vertices.size(), to_.vertices.data());
        fetch(from_.normals, to_.normals.size(), to_.normals.data());
        for (std::size_t a = 0; a < to_.attributes.size() && !to_.vertices.empty(); ++a)
            fetch(static_cast<const std::byte*>(from_.attributes[a].data), to_.attributes[a].data.size(),
                  to_.attributes[a].data.data());
        storage_->download.finish(storage_->stream);
        std::erase_if(to_.bricks, [](const MeshBrick& brick) { return brick.triangle_count() == 0; });
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
            fetch(from_.triangles + first, last.first + last.count - first, to_.triangles.data() + first);
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
    const DeviceMesh from_;
    const MeshBrick* const bricks_;
    Mesh& to_;
    std::atomic<bool> done_{false};
    std::atomic<std::size_t> arrived_{0};  ///< number of bricks whose triangles are there; 0 after a failure
    // Members that storage_->copying guards:
    bool started_ = false;
    std::exception_ptr error_;
    double seconds_ = 0.0;
    std::size_t fetch_bytes_ = first_fetch_bytes;
};

}  // namespace meniscus::cuda
