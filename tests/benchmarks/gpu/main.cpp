// meniscus-bench-gpu: meniscus-bench's commands for a GPU alone, where a kernel is edited: built without gRPC, in a
// minute.
#include <CLI/CLI.hpp>

#include "gpu/gpu.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
    CLI::App app("meniscus-bench's commands for a GPU", "meniscus-bench-gpu");
    meniscus::benchmarks::add_gpu_commands(app, meniscus::benchmarks::run_model_elsewhere);
    return meniscus::benchmarks::run_program(app, argc, argv);
}
