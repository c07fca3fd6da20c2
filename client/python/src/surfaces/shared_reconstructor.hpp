// A reconstructor that several threads and the meshes on its GPU share.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "meniscus/reconstructor.hpp"
#include "surfaces/mesh_pool.hpp"
#include "threads/turns.hpp"
#include "values/arrays_in.hpp"

namespace meniscus::python {

class SharedReconstructor {
public:
    /// Throws as Reconstructor does.
    SharedReconstructor(const Settings& settings, const BackendOptions& options);

    const Settings& settings() const { return content_.settings(); }
    /// "cpu" or "cuda".
    const std::string& backend() const { return backend_; }
    /// Calls that have changed its surface, or tried to: a mesh on the GPU is valid until the next.
    std::uint64_t calls() const { return calls_; }

    /// The work in a caller's turn: the reconstructor, the arrays, and the mesh to fill.
    struct Work {
        Reconstructor& content;
        OwnedFrame& frame;
        std::shared_ptr<Mesh> mesh;
    };
    /// In the caller's turn, with the interpreter's lock: `prepare`, before anything has changed; `compute`, without
    /// the lock, such that Ctrl-C ends it; then `use`. Each may throw.
    void run(const std::function<void(OwnedFrame&)>& prepare, const std::function<void(Work&)>& compute,
             const std::function<void(const Work&)>& use);
    /// Gives buffers back.
    void release_memory();

private:
    void run_in_turn(const std::function<void(OwnedFrame&)>& prepare, const std::function<void(Work&)>& compute,
                     const std::function<void(const Work&)>& use);

    std::shared_ptr<StopFlag> stop_ = std::make_shared<StopFlag>();
    Reconstructor content_;
    std::string backend_;
    OwnedFrame frame_;
    std::shared_ptr<MeshPool> meshes_ = std::make_shared<MeshPool>();
    Turns turns_;
    std::atomic<std::uint64_t> calls_ = 0;
};

}  // namespace meniscus::python
