// meniscus-bench-emulated: the commands for a GPU, on the device in software, where there is none. What they find out
// is how they work and that the kernels give the CPU's bytes; its times are 0.
#include <CLI/CLI.hpp>

#include "engine/cuda/device.hpp"
#include "gpu/gpu.hpp"
#include "model/model.hpp"
#include "program.hpp"

namespace meniscus::cuda {  // which has another name here (tests/core/CMakeLists.txt)

std::string why_unavailable(int) {
    return {};
}

std::string device_name(int) {
    return "device in software";
}

}  // namespace meniscus::cuda

int main(int argc, char** argv) {
    CLI::App app("meniscus-bench's commands for a GPU, on the device in software", "meniscus-bench-emulated");
    meniscus::benchmarks::add_gpu_commands(app, meniscus::benchmarks::run_model);
    return meniscus::benchmarks::run_program(app, argc, argv);
}
