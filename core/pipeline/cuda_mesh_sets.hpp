// The two sets of mesh arrays of a reconstruction: which one the next mesh goes into, and whether a download still
// reads the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "engine/arrays.hpp"
#include "engine/cuda/state.hpp"
#include "meniscus/device_packed_frame.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "pipeline/cuda_mesh_storage.hpp"
#include "pipeline/cuda_pending_mesh.hpp"

namespace meniscus::cuda {

/// A second set is taken only where a frame begins while the mesh before is still to be downloaded. Where there is no
/// memory for a second one, each mesh comes down before the next is made.
class MeshSets {
public:
    MeshSets(int device, const std::shared_ptr<MemoryAccount>& account,
             const std::shared_ptr<MemoryAccount>& device_account)
        : storage_(std::make_shared<MeshStorage>(device, account, device_account)) {}

    /// The set that the state's mesh arrays lie in.
    std::size_t current() const { return current_; }
    /// Number that changes when a set's arrays move.
    std::uint64_t version(std::size_t set) const { return versions_[set]; }

    /// Chooses a set that nothing reads for the mesh that comes, and lays the state's mesh arrays out in it. A mesh
    /// that must come down for that comes down here: its owner may wait for this very frame.
    void take(State& state) {
        if (const auto last = reader(current_)) {
            if (take_other(state)) return;
            last->finish();
        }
        with_room([&] { fit(state); });
    }

    /// Gives the current set the state's capacities.
    void fit(State& state) {
        ArrayMemory& memory = storage_->sets[current_];
        if (memory.bytes() != memory.bytes_for(state.mesh_arrays())) {
            ++versions_[current_];
            memory.assign(state.mesh_arrays());
            storage_->stream.synchronize();
        }
        memory.place(state.mesh_arrays());
    }

    /// Fault finding in the current set, before a mesh is made in it and after that; see ArrayMemory.
    void poison(State& state) { storage_->sets[current_].poison(state.mesh_arrays()); }
    void require_whole_guards(State& state) const {
        storage_->sets[current_].require_whole_guards(state.mesh_arrays());
    }

    /// Tries a second set again, after the capacities have changed: it may have room now.
    void forget_refusal() { one_set_must_do_ = false; }

    /// Calls allocate(); once more without the other set if there is too little memory.
    template <class Allocate>
    void with_room(const Allocate& allocate) {
        try {
            allocate();
        } catch (const LimitExceeded&) {
            const std::size_t other = 1 - current_;
            if (storage_->sets[other].bytes() == 0) throw;
            if (const auto pending = reader(other)) pending->finish();
            storage_->sets[other].release();
            storage_->stream.synchronize();
            allocate();
        }
    }

    /// Host memory for the mesh is taken here, so that none can be missing later. bricks: those without triangles
    /// included.
    MeshDownload download(const MeshOnDevice& from, std::size_t bricks, Mesh& mesh) {
        const DeviceMesh& on_device = from.mesh;
        resize_for_overwrite(mesh.vertices, on_device.vertex_count);
        resize_for_overwrite(mesh.normals, on_device.normals != nullptr ? on_device.vertex_count : 0);
        resize_for_overwrite(mesh.triangles, on_device.triangle_count);
        for (MeshAttribute& attribute : mesh.attributes)
            resize_for_overwrite(attribute.data, on_device.vertex_count * attribute.element_bytes());
        resize_for_overwrite(mesh.bricks, bricks);
        resize_for_overwrite(mesh.lattice.blocks, from.lattice_blocks);
        mesh.levels = on_device.levels;
        auto pending = std::make_shared<PendingMesh>(storage_, from, mesh);
        pending_[current_] = pending;
        return MeshDownload(std::move(pending));
    }

    /// Packs a mesh that stays; see BackendReconstruction::pack_on_device().
    void pack(const MeshOnDevice& from, std::size_t bricks, Mesh& mesh, const CodingOptions& options,
              std::span<const AttributeWish> wishes, DevicePackedFrame& packed) {
        resize_for_overwrite(mesh.bricks, bricks);
        PendingMesh stays(storage_, from, mesh);
        CodingOptions of_all = options;
        of_all.attributes = coded_attributes(mesh, stays.attribute_ranges(), wishes);
        const auto of_mesh = stays.packed(of_all);
        packed.bricks = of_mesh->all();
        packed.memory = of_mesh;
        packed.attributes = std::move(of_all.attributes);
    }

    /// Frees the sets when the reconstruction ends. A mesh's owner may keep its download for long, and the next
    /// reconstruction needs the room: only the host's memory may outlive this one. kernels: the stream that may still
    /// write a set.
    void give_back(Stream& kernels) noexcept {
        const auto attempt = [](const auto& action) {
            try {
                action();
            } catch (...) {
                // The device failed: a caller that asks for the incomplete mesh gets the error then.
            }
        };
        attempt([&] { kernels.synchronize(); });
        for (std::size_t set = 0; set < pending_.size(); ++set) {
            if (const auto pending = reader(set)) attempt([&] { pending->finish(); });
            storage_->sets[set].release();
        }
        attempt([&] {
            const std::lock_guard lock(storage_->copying);
            storage_->to_pack_in.clear();
            storage_->stream.synchronize();
        });
    }

private:
    /// The download that still reads a set; none if nothing does.
    std::shared_ptr<PendingMesh> reader(std::size_t set) const {
        auto pending = pending_[set].lock();
        return pending && !pending->is_done() ? pending : nullptr;
    }

    /// Returns whether there is room for a second set. Where there was none, every frame would try in vain until the
    /// sizes change.
    bool take_other(State& state) {
        if (one_set_must_do_) return false;
        current_ = 1 - current_;
        if (const auto earlier = reader(current_)) earlier->finish();
        try {
            fit(state);
            return true;
        } catch (const LimitExceeded&) {
            current_ = 1 - current_;
            one_set_must_do_ = true;
            return false;
        }
    }

    std::shared_ptr<MeshStorage> storage_;
    std::array<std::weak_ptr<PendingMesh>, 2> pending_;
    std::array<std::uint64_t, 2> versions_{};
    std::size_t current_ = 0;
    bool one_set_must_do_ = false;  ///< whether a second set of these capacities was refused
};

}  // namespace meniscus::cuda
