// The commands that compare or measure a GPU. The program on the software device (emulated_main.cpp) has the same ones.
#pragma once

#include <stdexcept>

namespace CLI {
class App;
}

namespace meniscus::benchmarks {

/// Exit code where there is no GPU.
inline constexpr int no_gpu_exit_code = 77;

class NoGpu : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws NoGpu if the first GPU cannot be used here.
void require_gpu();

struct KernelsOptions;

void add_same(CLI::App& app);
void add_exact(CLI::App& app);
void add_transfers(CLI::App& app);
/// Runs the others, and more programs.
void add_check(CLI::App& app);
/// run_model: for --model.
void add_kernels(CLI::App& app, void (*run_model)(const KernelsOptions&));
/// All of them, in the order in which --help lists them.
inline void add_gpu_commands(CLI::App& app, void (*run_model)(const KernelsOptions&)) {
    add_same(app);
    add_exact(app);
    add_kernels(app, run_model);
    add_transfers(app);
    add_check(app);
}
/// Goes on as meniscus-bench-emulated, beside this program, with the same arguments: the model counts on the device in
/// software. Throws std::runtime_error if that is not there.
void run_model_elsewhere(const KernelsOptions& options);

}  // namespace meniscus::benchmarks
