// meniscus-bench: measurements, each with the machine, the commit and the command that gave them.
#include <CLI/CLI.hpp>

#include "benchmarks.hpp"
#include "gpu/gpu.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
    CLI::App app("Measures what reconstruction, encoding, uploads and the service cost, and how good surfaces are",
                 "meniscus-bench");
    meniscus::benchmarks::add_experiment(app);
    meniscus::benchmarks::add_scaling(app);
    meniscus::benchmarks::add_encoding(app);
    meniscus::benchmarks::add_codecs(app);
    meniscus::benchmarks::add_lattice_tables(app);
    meniscus::benchmarks::add_goals(app);
    meniscus::benchmarks::add_upload(app);
    meniscus::benchmarks::add_service(app);
    meniscus::benchmarks::add_delivery(app);
    meniscus::benchmarks::add_publishing(app);
    meniscus::benchmarks::add_pushing(app);
    meniscus::benchmarks::add_surfaces(app);
    meniscus::benchmarks::add_quality(app);
    meniscus::benchmarks::add_gpu_commands(app, meniscus::benchmarks::run_model_elsewhere);
    return meniscus::benchmarks::run_program(app, argc, argv);
}
