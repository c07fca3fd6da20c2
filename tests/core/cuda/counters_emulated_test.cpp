// Counters that the whole grid shares, on the device in software.
#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "engine/cuda/launch_observer.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// Additions of a kernel, by whether the first thread of a block makes them.
struct Additions {
    int by_first = 0, by_others = 0;
};

/// Runs each kernel by itself, and counts its atomic additions.
class AdditionsByKernel final : public cuda::LaunchObserver {
public:
    AdditionsByKernel() {
        cuda::launch_observer = this;
        emulated_device::on_addition = [this](const void*) {
            Additions& additions = by_kernel[kernel_];
            ++(threadIdx.x == 0 ? additions.by_first : additions.by_others);
        };
    }
    ~AdditionsByKernel() {
        cuda::launch_observer = nullptr;
        emulated_device::on_addition = nullptr;
    }
    AdditionsByKernel(const AdditionsByKernel&) = delete;
    AdditionsByKernel& operator=(const AdditionsByKernel&) = delete;

    void before(const cuda::Launch& launch) override {
        const char* name = "";
        if (launch.kind == cuda::LaunchKind::kernel) cudaFuncGetName(&name, launch.kernel);
        kernel_ = name;
    }
    void after(const cuda::Launch& launch) noexcept override { cudaStreamSynchronize(launch.stream); }

    Additions of(std::string_view kernel) const {
        Additions all;
        for (const auto& [name, additions] : by_kernel)
            if (name.find(kernel) != std::string::npos) {
                all.by_first += additions.by_first;
                all.by_others += additions.by_others;
            }
        return all;
    }
    std::map<std::string, Additions> by_kernel;

private:
    std::string kernel_;
};

TEST(CountersEmulated, AreAddedToByOneThreadOfABlock) {
    AdditionsByKernel additions;
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings settings = test::default_settings();
        settings.mode = mode;
        if (mode == Mode::uniform) settings.edge_points = Bisection{};
        const auto backend = cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                                       std::make_shared<MemoryAccount>());
        const test::Particles particles = test::splash(3, 8);
        Mesh mesh;
        Statistics statistics;
        backend->reconstruct(particles.frame(), mesh, statistics).finish();
    }
    for (const std::string_view kernel :
         {"store_particles", "fit_kernels", "mark_reached_cells", "measure_band", "list_corner_points", "sample_list",
          "list_edge_middles", "list_half_edge_middles", "list_band", "count_cells", "count_vertices", "place_listed",
          "add_volumes"}) {
        SCOPED_TRACE(kernel);
        EXPECT_GT(additions.of(kernel).by_first, 0);
        EXPECT_EQ(additions.of(kernel).by_others, 0);
    }
}

}  // namespace
}  // namespace meniscus
