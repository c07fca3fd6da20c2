// A build without the CUDA backend has the commands for a GPU in name only.
#include <CLI/CLI.hpp>

#include "gpu/gpu.hpp"
#include "gpu/kernels_options.hpp"

namespace meniscus::benchmarks {
namespace {

void add_absent(CLI::App& app, const char* name, const char* description) {
    CLI::App& command = *app.add_subcommand(name, description);
    command.allow_extras();
    command.callback([] { require_gpu(); });
}

}  // namespace

void add_same(CLI::App& app) {
    add_absent(app, "same", "The GPU's meshes against the CPU's: this build has no CUDA backend");
}
void add_exact(CLI::App& app) {
    add_absent(app, "exact", "What the backend takes for granted of a GPU: this build has no CUDA backend");
}
void add_transfers(CLI::App& app) {
    add_absent(app, "transfers", "Copies to the GPU and back: this build has no CUDA backend");
}
void add_kernels(CLI::App& app, void (*run_model)(const KernelsOptions&)) {
    static void (*model)(const KernelsOptions&) = nullptr;
    model = run_model;
    add_kernels_command(app, [](const KernelsOptions& options) {
        if (options.is_model) return model(options);
        require_gpu();
    });
}

}  // namespace meniscus::benchmarks
