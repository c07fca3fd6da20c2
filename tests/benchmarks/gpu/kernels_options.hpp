// The frame that `meniscus-bench kernels` takes apart.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/backend.hpp"
#include "water.hpp"

namespace CLI {
class App;
}

namespace meniscus::benchmarks {

struct KernelsOptions {
    std::size_t particles = 64 * basin_particles;
    double cell_size = 1.0;
    std::string field = "smooth";
    std::string mode = "uniform";
    std::string water = "splashing";
    unsigned repeats = 20;
    bool packs = false;  ///< whether its bricks are packed
    std::string out = "kernels-results";
    // Of the model:
    bool is_model = false;
    std::string ptx;           ///< folder that kernel-ptx has written
    std::string gpu = "H200";  ///< a row of gpus.csv
    std::size_t counted = 0;   ///< particles of the frame that is counted; 0: as many as there are
};

/// The subcommand with all its flags; run is called for it.
void add_kernels_command(CLI::App& app, void (*run)(const KernelsOptions&));

/// A frame of generated water, again and again on the GPU.
class WarmFrame {
public:
    WarmFrame(const KernelsOptions& options, std::size_t particles);
    /// packs: with its bricks, which stay on the GPU.
    void reconstruct();
    /// The same, with its mesh as the host gets it, which is held against the CPU's. Throws std::runtime_error where it
    /// differs.
    void reconstruct_as_the_cpu_does() {
        reconstruct_as_the_cpu_does([](const MeshDownload&, const Mesh&, const Mesh&) {});
    }
    /// before_it_comes: gets the download, its mesh, and the CPU's.
    void reconstruct_as_the_cpu_does(
        const std::function<void(const MeshDownload&, const Mesh&, const Mesh&)>& before_it_comes);
    /// Until it launches the same again and again.
    void warm_up();
    std::size_t particles() const { return positions_.size() / 3; }

private:
    ParticleFrame frame() const;

    std::vector<float> positions_;
    Settings settings_;
    bool keeps_lattice_;
    Mesh mesh_;  ///< whose bricks are packed
    std::unique_ptr<BackendReconstruction> backend_;
};

}  // namespace meniscus::benchmarks
