// Memory of meshes that nobody looks at any more: new memory costs a page fault for every 4 KiB.
#pragma once

#include <memory>
#include <mutex>

#include "meniscus/mesh.hpp"

namespace meniscus::python {

/// Keeps one mesh, the last that came back: a caller that looks at the mesh of one frame while the next is made needs
/// two in turn. Thread-safe; meshes outlive it.
class MeshPool {
public:
    /// A mesh for the next frame, with the memory of an earlier one if there is one.
    static std::shared_ptr<Mesh> take(const std::shared_ptr<MeshPool>& pool);
    /// Gives the memory back.
    void clear();

private:
    void give_back(std::unique_ptr<Mesh> mesh);

    std::mutex mutex_;
    std::unique_ptr<Mesh> idle_;
};

}  // namespace meniscus::python
