#include "surfaces/mesh_pool.hpp"

#include <utility>

#include "threads/process.hpp"

namespace meniscus::python {

std::shared_ptr<Mesh> MeshPool::take(const std::shared_ptr<MeshPool>& pool) {
    std::unique_ptr<Mesh> mesh;
    {
        const std::lock_guard lock(pool->mutex_);
        mesh = std::move(pool->idle_);
    }
    if (!mesh) mesh = std::make_unique<Mesh>();
    return {mesh.release(), [weak = std::weak_ptr(pool)](Mesh* returned) {
                if (is_forked()) return;
                std::unique_ptr<Mesh> owned(returned);
                if (const auto alive = weak.lock()) alive->give_back(std::move(owned));
            }};
}

void MeshPool::clear() {
    give_back(nullptr);
}

void MeshPool::give_back(std::unique_ptr<Mesh> mesh) {
    const std::lock_guard lock(mutex_);
    idle_.swap(mesh);
}

}  // namespace meniscus::python
