#include "gpu/kernels_options.hpp"

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "gpu/mesh_difference.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::benchmarks {

void add_kernels_command(CLI::App& app, void (*run)(const KernelsOptions&)) {
    auto options = std::make_shared<KernelsOptions>();
    CLI::App& command = *app.add_subcommand(
        "kernels",
        "Time, grid and registers of every launch of a warm frame on the GPU (exit code 77 without one), or with "
        "--model the times that counts foretell, without a GPU");
    command.add_option("--particles", options->particles, "In basins of 16000, or fewer")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 32U))
        ->capture_default_str();
    command.add_option("--cell-size", options->cell_size, "In radii")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--field", options->field, listed(names<Field>))->capture_default_str();
    command.add_option("--mode", options->mode, listed(names<Mode>))->capture_default_str();
    command.add_option("--water", options->water, listed(names<WaterKind>))->capture_default_str();
    command.add_option("--repeats", options->repeats, "Warm frames, of which the medians count")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    CLI::Option* const model = command.add_flag(
        "--model", options->is_model, "Foretell: run the kernels' PTX on the device in software, count, and price");
    command.add_option("--ptx", options->ptx, "Folder that tests/benchmarks/kernel-ptx has written")
        ->check(CLI::ExistingDirectory)
        ->needs(model);
    command.add_option("--gpu", options->gpu, "A row of tests/benchmarks/model/gpus.csv")
        ->needs(model)
        ->capture_default_str();
    command
        .add_option("--counted", options->counted,
                    "Particles of the frame that is counted, of which the frame is so many times as much, on as many "
                    "times the multiprocessors; 0: --particles")
        ->needs(model)
        ->capture_default_str();
    command.add_flag("--packed", options->packs,
                     "Also pack the frame's bricks, with normals of 8 bits: a sum of its own beside the frame's");
    command.callback([options, run] { run(*options); });
}

WarmFrame::WarmFrame(const KernelsOptions& options, std::size_t particles)
    : positions_(make_any_water(by_name<WaterKind>(options.water, "water"), particles, 0.025F)),
      keeps_lattice_(options.packs) {
    settings_.particle_radius = 0.025;
    settings_.cell_size = options.cell_size;
    settings_.mode = by_name<Mode>(options.mode, "mode");
    settings_.field = by_name<Field>(options.field, "field");
    mesh_.cell_size = world_cell_size(settings_);
    mesh_.offset_bits = offset_bits(settings_);
    BackendOptions backend;
    backend.keep_lattice = keeps_lattice_;
    backend_ = cuda::make_reconstruction(settings_, backend, std::make_shared<MemoryAccount>(),
                                         std::make_shared<MemoryAccount>());
}

ParticleFrame WarmFrame::frame() const {
    ParticleFrame frame;
    frame.positions = positions_;
    return frame;
}

void WarmFrame::reconstruct() {
    Statistics statistics;
    if (!keeps_lattice_) {
        static_cast<void>(backend_->reconstruct_on_device(frame(), statistics));
        return;
    }
    const MeshDownload download = backend_->reconstruct(frame(), mesh_, statistics);
    if (download.pack(mesh_, {.codec = Codec::lattice_packed}) == nullptr)
        throw std::runtime_error("the GPU has too little memory for the packed bricks");
}

void WarmFrame::reconstruct_as_the_cpu_does(
    const std::function<void(const MeshDownload&, const Mesh&, const Mesh&)>& before_it_comes) {
    Mesh expected;
    Reconstructor(settings_, {.backend = Backend::cpu, .keep_lattice = keeps_lattice_}).reconstruct(frame(), expected);
    Mesh mesh;
    mesh.cell_size = expected.cell_size;
    mesh.offset_bits = expected.offset_bits;
    Statistics statistics;
    const MeshDownload download = backend_->reconstruct(frame(), mesh, statistics);
    before_it_comes(download, mesh, expected);
    download.finish();
    const MeshDifference difference = find_difference(expected, mesh);
    if (difference.any()) throw std::runtime_error("the mesh is not the CPU's: " + difference.first);
}

void WarmFrame::warm_up() {
    for (int i = 0; i < 4; ++i) reconstruct();
}

}  // namespace meniscus::benchmarks
