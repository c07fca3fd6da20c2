// kernel-lab: are the kernels that were just built right, and what do they take?
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "gpu/mesh_difference.hpp"
#include "kernel_times.hpp"
#include "lab_options.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "meniscus/reconstructor.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks {
namespace {

constexpr int no_gpu = 77;

/// A time for each step and for all of them, milliseconds.
struct Times {
    double frame = 0.0;
    std::array<double, stage_count> steps{};
};

/// Medians of warm frames. On a GPU of the time between its events, without the mesh's way to the host.
Times time_frames(Reconstructor& reconstructor, const ParticleFrame& frame, unsigned runs, Mesh& mesh) {
    std::array<std::vector<double>, stage_count> steps;
    std::vector<double> frames;
    for (unsigned run = 0; run < runs; ++run) {
        reconstructor.reconstruct(frame, mesh);
        double sum = 0.0;
        for (std::size_t i = 0; i < stage_count; ++i) {
            const double milliseconds = 1e3 * reconstructor.statistics().stage_seconds[i];
            steps[i].push_back(milliseconds);
            sum += milliseconds;
        }
        frames.push_back(sum);
    }
    Times times;
    times.frame = median(frames);
    for (std::size_t i = 0; i < stage_count; ++i) times.steps[i] = median(steps[i]);
    return times;
}

/// True if the meshes are the same.
bool try_case(const LabOptions& options, const std::vector<float>& positions, const Settings& settings) {
    constexpr int warm_up = 3;  // grown, run launch by launch, captured
    ParticleFrame frame;
    frame.positions = positions;
    Reconstructor tried(settings, {options.backend, 0, 0});
    Mesh mesh;
    for (int i = 0; i < warm_up; ++i) tried.reconstruct(frame, mesh);
    const Times times = time_frames(tried, frame, options.runs, mesh);
    MeshDifference difference;
    if (options.compare) {
        Mesh expected;
        Reconstructor(settings, {Backend::cpu, 0, 0}).reconstruct(frame, expected);
        difference = find_difference(expected, mesh);
    }
    std::printf("%s, %.3f ms, %zu triangles;",
                !options.compare   ? "not compared"
                : difference.any() ? "DIFFERENT"
                                   : "same",
                times.frame, mesh.triangles.size());
    for (std::size_t i = 0; i < stage_count; ++i)
        std::printf(" %s %.3f", std::string(names<Stage>[i]).c_str(), times.steps[i]);
    std::printf("\n");
    if (difference.any()) std::printf("    %s\n", difference.first.c_str());
    if (options.kernels) print_kernel_times(frame, settings, options.runs);
    std::fflush(stdout);
    return !difference.any();
}

bool try_all(const LabOptions& options) {
    bool same = true;
    Settings settings;
    settings.particle_radius = 0.025;
    for (const std::size_t particles : options.particles)
        for (const WaterKind water : options.waters) {
            const std::vector<float> positions =
                make_water(water, particles, static_cast<float>(settings.particle_radius));
            for (const Field field : options.fields)
                for (const double cell_size : options.cell_sizes)
                    for (const Mode mode : options.modes) {
                        settings.field = field;
                        settings.cell_size = cell_size;
                        settings.mode = mode;
                        std::printf("%zu %s c = %g %s %s: ", positions.size() / 3, std::string(name_of(water)).c_str(),
                                    cell_size, std::string(name_of(field)).c_str(), std::string(name_of(mode)).c_str());
                        same = try_case(options, positions, settings) && same;
                    }
        }
    return same;
}

int run(int argc, const char* const* argv) {
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
        std::fputs(lab_help(), stdout);
        return 0;
    }
    const LabOptions options = read_lab_options(argc, argv);
    if (options.backend == Backend::cuda) {
        const BackendDescription found = describe_backend(Backend::automatic);
        if (found.backend != Backend::cuda) {
            std::fprintf(stderr, "kernel-lab: no GPU: %s\n", found.reason.c_str());
            return no_gpu;
        }
        std::printf("%s\n", found.device.c_str());
    }
    return try_all(options) ? 0 : 1;
}

}  // namespace
}  // namespace meniscus::benchmarks

int main(int argc, char** argv) {
    try {
        return meniscus::benchmarks::run(argc, argv);
    } catch (const meniscus::InvalidInput& e) {
        std::fprintf(stderr, "kernel-lab: %s\n", e.what());
        return 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "kernel-lab: %s\n", e.what());
        return 1;
    }
}
