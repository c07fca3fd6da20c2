// One mesh on its way to the host.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <utility>

#include "backends/cuda/mesh_storage.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"

namespace meniscus::cuda {

/// Vertices come down whole, since bricks share them; then triangles, some bricks at a time. Nothing is on its way between two calls.
class PendingMesh final : public MeshDownload::Source {
public:
    /// `to` has the mesh's sizes, and room for all `bricks`, those without triangles included.
    PendingMesh(std::shared_ptr<MeshStorage> storage, const DeviceMesh& from, const MeshBrick* bricks, Mesh& to)
        : storage_(std::move(storage)), from_(from), bricks_(bricks), to_(to) {}

    void start() override {
        proceed([] {});
    }
    void bring(std::size_t brick) override {
        proceed([&] {
            while (arrived_ <= brick && arrived_ < to_.bricks.size()) fetch_bricks();
        });
    }
    void finish() override {
        proceed([&] {
            while (arrived_ < to_.bricks.size()) fetch_bricks();
        });
    }
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
    /// Enough for a copy to be worth its launch, and few enough for the first brick to be there soon.
    static constexpr std::size_t fetch_bytes = std::size_t{256} << 10;

    template <class Fetch>
    void proceed(const Fetch& fetch) {
        const std::lock_guard lock(storage_->copying);
        if (error_) std::rethrow_exception(error_);
        if (done_) return;
        const auto start = std::chrono::steady_clock::now();
        try {
            const CurrentDevice current(storage_->device);
            if (!std::exchange(started_, true)) fetch_vertices();
            fetch();
            done_ = arrived_ == to_.bricks.size();
        } catch (...) {
            error_ = std::current_exception();
            storage_->download.forget();
            done_ = true;
            throw;
        }
        seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    void fetch_vertices() {
        fetch(bricks_, to_.bricks.size(), to_.bricks.data());
        fetch(from_.vertices, to_.vertices.size(), to_.vertices.data());
        fetch(from_.normals, to_.normals.size(), to_.normals.data());
        storage_->download.finish();
        std::erase_if(to_.bricks, [](const MeshBrick& brick) { return brick.triangle_count() == 0; });
    }

    void fetch_bricks() {
        std::size_t end = arrived_;
        for (std::size_t triangles = 0; end < to_.bricks.size() && triangles * sizeof(Triangle) < fetch_bytes; ++end) triangles += to_.bricks[end].triangle_count();
        // Within a level, the triangles of successive bricks follow one another.
        for (std::size_t level = 0; level < triangle_level_count; ++level) {
            const std::uint32_t first = to_.bricks[arrived_].ranges[level].first;
            const TriangleRange& last = to_.bricks[end - 1].ranges[level];
            fetch(from_.triangles + first, last.first + last.count - first, to_.triangles.data() + first);
        }
        storage_->download.finish();
        arrived_ = end;
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
    // With storage_->copying held:
    bool started_ = false;
    std::size_t arrived_ = 0;  ///< bricks whose triangles are there
    std::exception_ptr error_;
    double seconds_ = 0.0;
};

}  // namespace meniscus::cuda
