// meniscus-bench-gpu: meniscus-bench's commands for a GPU alone, where a kernel is edited: built without gRPC, in a
// minute.
#include <CLI/CLI.hpp>

#include "gpu/gpu.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
    CLI::App app("meniscus-bench's commands for a GPU", "meniscus-bench-gpu");
    meniscus::benchmarks::add_same(app);
    meniscus::benchmarks::add_exact(app);
    meniscus::benchmarks::add_kernels(app, meniscus::benchmarks::run_model_elsewhere);
    meniscus::benchmarks::add_transfers(app);
    meniscus::benchmarks::add_check(app);
    return meniscus::benchmarks::run_program(app, argc, argv);
}
