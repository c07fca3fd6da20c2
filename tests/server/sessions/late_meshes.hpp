// Sessions' meshes that come down late, as from a GPU: made on the CPU at once, there when they are asked for and the
// test lets them.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/mesh_download.hpp"
#include "simulator_player.hpp"

namespace meniscus::server::test {

/// The state that a test shares with its meshes.
class LateMeshes {
public:
    std::atomic<int> made{0};       ///< frames
    std::atomic<int> asked_for{0};  ///< meshes whose download was begun
    std::atomic<int> waiting{0};    ///< meshes that may still be asked for
    std::atomic<bool> fails{false};

    void hold() { set_held(true); }
    void let_go() { set_held(false); }
    void wait_for_permission() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !held_; });
    }

private:
    void set_held(bool held) {
        {
            const std::lock_guard lock(mutex_);
            held_ = held;
        }
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    bool held_ = false;
};

class LateMesh final : public MeshDownload::Source {
public:
    /// Leaves of the mesh what a backend knows before the download: its sizes.
    LateMesh(std::shared_ptr<LateMeshes> meshes, Mesh& to) : meshes_(std::move(meshes)), made_(to), to_(to) {
        ++meshes_->waiting;
        std::ranges::fill(to_.vertices, LatticePosition{});
        std::ranges::fill(to_.triangles, Triangle{});
        to_.bricks.clear();
    }

    void start() override {
        const std::lock_guard lock(mutex_);
        if (std::exchange(started_, true)) return;
        ++meshes_->asked_for;
        meshes_->wait_for_permission();
        to_.vertices = made_.vertices;
        to_.bricks = made_.bricks;
    }
    void bring(std::size_t brick) override {
        start();
        if (meshes_->fails) throw DeviceError("cudaEventSynchronize", "unspecified launch failure", 1);
        const std::lock_guard lock(mutex_);
        for (const TriangleRange& range : made_.bricks[brick].ranges)
            std::copy_n(made_.triangles.begin() + range.first, range.count, to_.triangles.begin() + range.first);
    }
    void finish() override {
        for (std::size_t brick = 0; brick < made_.bricks.size(); ++brick) bring(brick);
    }
    std::shared_ptr<PackedBricks> pack(const CodingOptions&) override { return nullptr; }
    std::vector<AttributeRange> attribute_ranges() override {
        start();
        return meniscus::attribute_ranges(to_);
    }
    void abandon() noexcept override { --meshes_->waiting; }
    double seconds() const override { return 0.25; }

private:
    const std::shared_ptr<LateMeshes> meshes_;
    const Mesh made_;
    Mesh& to_;
    std::mutex mutex_;
    bool started_ = false;
};

inline decltype(ReconstructFunctions::reconstruct) reconstruct_late(std::shared_ptr<LateMeshes> meshes) {
    return [meshes = std::move(meshes), cpu = reconstruct_on_the_cpu()](const ParticleFrame& frame, Mesh& mesh) {
        Statistics statistics = cpu(frame, mesh).statistics;
        MeshDownload download(std::make_shared<LateMesh>(meshes, mesh));
        ++meshes->made;
        return Reconstructed(std::move(statistics), std::move(download));
    };
}

}  // namespace meniscus::server::test
