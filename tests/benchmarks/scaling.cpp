// meniscus-bench scaling: how time and memory grow with the particles, and how far they are from the floor.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backend_options.hpp"
#include "benchmarks.hpp"
#include "device_peaks.hpp"
#include "formats/particles/particle_file.hpp"
#include "machine_peaks.hpp"
#include "meniscus/error.hpp"
#include "neighbors.hpp"
#include "report.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

/// From one size to the next.
constexpr std::size_t growth = 4;
/// Cell sizes in radii.
constexpr double coarse = 1.0;
constexpr double fine = 0.5;

struct ScalingOptions {
    std::size_t min_particles = basin_particles;
    std::size_t max_particles = 1024 * basin_particles;
    std::size_t max_particles_fine = 256 * basin_particles;
    std::vector<Field> fields{Settings{}.field};
    std::vector<double> cell_sizes{coarse, fine};  ///< in radii
    BackendOptions backend = one_cpu_thread;
    std::optional<double> tolerance;
    RepeatLimits limits;
    std::string out = "tests/benchmarks/results";
    std::string frame;        ///< a file, in place of generated water
    std::string write_water;  ///< a file for the water, in place of measurements
    double particle_radius = 0.025;
};

/// Vector instructions for one particle's share in the field at a point. Color: distance 7, kernel 10, sum 1. Smooth:
/// squared distance 6, kernel 3, sum 1.
double instructions_per_kernel(const Settings& settings) {
    return settings.field == Field::smooth ? 10.0 : 18.0;
}

/// Particles within whose support a place lies, on average.
struct Neighborhood {
    double of_particle = 0.0;  ///< see ParticlesNear::summed_at_particle()
    double of_vertex = 0.0;
};

Neighborhood sample_neighborhood(const std::vector<float>& positions, const Mesh& mesh, const Settings& settings) {
    constexpr std::size_t samples = 2000;
    ParticlesNear near(positions, settings);
    Neighborhood sums;
    const std::vector<std::size_t> particles = pick_evenly(positions.size() / 3, samples);
    for (const std::size_t i : particles) sums.of_particle += static_cast<double>(near.summed_at_particle(i));
    const std::vector<std::size_t> vertices = pick_evenly(mesh.vertices.size(), samples);
    for (const std::size_t i : vertices) {
        const auto place = mesh.world(mesh.vertices[i]);
        const float at[3] = {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])};
        sums.of_vertex += static_cast<double>(near.reaching(at));
    }
    const auto mean = [](double sum, std::size_t n) { return n == 0 ? 0.0 : sum / static_cast<double>(n); };
    return {mean(sums.of_particle, particles.size()), mean(sums.of_vertex, vertices.size())};
}

/// Adds the work that no faster program could avoid: the kernel for every pair within a particle's own support (the
/// sums at the particles, the field at its points, whose neighborhoods are taken to be like the vertices'), and one
/// pass over the memory.
void add_floor(Row& row, const Statistics& s, const Settings& settings, const Neighborhood& neighbors,
               const MachinePeaks& peaks) {
    const double kernels = static_cast<double>(s.particles) * neighbors.of_particle +
                           static_cast<double>(s.field_evaluations) * neighbors.of_vertex;
    const unsigned cores = s.backend == "cuda" ? 1 : s.threads;  // a device's peaks are those of all of it
    const double kernel_seconds =
        kernels * instructions_per_kernel(settings) / (peaks.multiply_adds_per_second * cores);
    const double copy_seconds = static_cast<double>(reconstruction_bytes(s)) / peaks.copied_bytes_per_second;
    row["particles_in_support_of_particle"] = neighbors.of_particle;
    row["particles_in_support_of_vertex"] = neighbors.of_vertex;
    row["kernel_evaluations"] = kernels;
    row["instructions_per_kernel"] = instructions_per_kernel(settings);
    row["share_of_multiply_add_peak"] = kernel_seconds / reconstruction_seconds(s);
    row["share_of_copy_bandwidth"] = copy_seconds / reconstruction_seconds(s);
}

Row measure(const ScalingOptions& options, const std::string& scene, const std::vector<float>& positions, Field field,
            double cell_size, Mode mode, const MachinePeaks& peaks) {
    Settings settings;
    settings.field = field;
    settings.particle_radius = options.particle_radius;
    settings.cell_size = cell_size;
    settings.mode = mode;
    settings.criterion = CurvatureCriterion{options.tolerance};
    ParticleFrame frame;
    frame.positions = positions;
    Mesh mesh;
    const WarmRuns runs = reconstruct_repeatedly(frame, settings, options.backend, options.limits, mesh);
    const Statistics& s = runs.median;
    const auto particles = static_cast<double>(s.particles);

    Row row;
    row["water"] = scene;
    row["field"] = name_of(field);
    row["cell_size"] = cell_size;
    row["mode"] = name_of(mode);
    row["tolerance"] = tolerance(settings);
    row["particles"] = s.particles;
    row["warm_runs"] = runs.count;
    row["first_seconds"] = runs.first.total_seconds;
    row["first_over_warm"] = runs.first.total_seconds / s.total_seconds;
    add_statistics(row, s);
    row["seconds_per_million_particles"] = 1e6 * reconstruction_seconds(s) / particles;
    row["bytes_per_particle"] = static_cast<double>(reconstruction_bytes(s)) / particles;
    row["bytes_per_triangle"] = static_cast<double>(reconstruction_bytes(s)) / static_cast<double>(s.triangles);
    add_floor(row, s, settings, sample_neighborhood(positions, mesh, settings), peaks);
    return row;
}

void print(const Row& row) {
    std::cout << std::left << std::setw(10) << row["water"].get<std::string>() << std::setw(8)
              << row["field"].get<std::string>() << std::setw(5) << row["cell_size"].get<double>() << std::setw(9)
              << row["mode"].get<std::string>() << std::right << std::setw(10) << row["particles"].get<std::uint64_t>()
              << std::fixed << std::setprecision(3) << std::setw(10)
              << row["seconds_per_million_particles"].get<double>() << std::setprecision(2) << std::setw(8)
              << row["first_over_warm"].get<double>() << std::setprecision(0) << std::setw(10)
              << row["bytes_per_particle"].get<double>() << std::setw(10) << row["bytes_per_triangle"].get<double>()
              << std::setw(8) << row["allocations"].get<std::uint64_t>() << std::setprecision(3) << std::setw(8)
              << row["share_of_multiply_add_peak"].get<double>() << std::setw(8)
              << row["share_of_copy_bandwidth"].get<double>() << std::defaultfloat << std::endl;
}

/// For every scene, cell size and mode: the largest against the smallest.
Rows compare_sizes(const Rows& rows) {
    Rows out = Rows::array();
    for (const Row& largest : rows) {
        const auto same_series = [&](const Row& row) {
            return row["water"] == largest["water"] && row["field"] == largest["field"] &&
                   row["cell_size"] == largest["cell_size"] && row["mode"] == largest["mode"];
        };
        const auto is_larger = [&](const Row& row) {
            return same_series(row) && row["particles"] > largest["particles"];
        };
        if (std::any_of(rows.begin(), rows.end(), is_larger)) continue;
        const Row& smallest = *std::find_if(rows.begin(), rows.end(), same_series);
        const auto ratio = [&](const char* name) { return largest[name].get<double>() / smallest[name].get<double>(); };
        out.push_back({{"water", largest["water"]},
                       {"field", largest["field"]},
                       {"cell_size", largest["cell_size"]},
                       {"mode", largest["mode"]},
                       {"particles_smallest", smallest["particles"]},
                       {"particles_largest", largest["particles"]},
                       {"time_per_particle_ratio", ratio("seconds_per_million_particles")},
                       {"memory_per_particle_ratio", ratio("bytes_per_particle")}});
    }
    return out;
}

void print_comparison(const Row& row) {
    std::cout << std::left << std::setw(10) << row["water"].get<std::string>() << std::setw(8)
              << row["field"].get<std::string>() << std::setw(5) << row["cell_size"].get<double>() << std::setw(9)
              << row["mode"].get<std::string>() << std::right << std::fixed << std::setprecision(2) << std::setw(8)
              << row["time_per_particle_ratio"].get<double>() << std::setw(8)
              << row["memory_per_particle_ratio"].get<double>() << std::defaultfloat << '\n';
}

void write_water(const ScalingOptions& options) {
    const std::vector<float> positions =
        make_water(WaterKind::splashing, options.max_particles, static_cast<float>(options.particle_radius));
    ParticleFrame frame;
    frame.positions = positions;
    formats::write_particles(options.write_water, frame, formats::ParticleFormat::vtk);
}

void run_scaling(const ScalingOptions& options) {
    if (options.min_particles > options.max_particles)
        throw InvalidInput("--min-particles is " + std::to_string(options.min_particles) +
                           ", must be at most --max-particles, " + std::to_string(options.max_particles));
    nlohmann::ordered_json summary;
    summary["runs"] = "warm medians; first: a new reconstructor's first frame";
    add_backend(summary, options.backend);
    const bool on_device = summary["backend"] == "cuda";
    const MachinePeaks peaks = on_device ? measure_device_peaks() : measure_peaks();
    summary["peaks_of"] = on_device ? "the device" : "one core";
    summary["multiply_adds_per_second"] = peaks.multiply_adds_per_second;
    summary["copied_bytes_per_second"] = peaks.copied_bytes_per_second;
    std::cout << "multiply-add peak " << 1e-9 * peaks.multiply_adds_per_second << " G/s, copy bandwidth "
              << 1e-9 * peaks.copied_bytes_per_second << " GB/s, of " << summary["peaks_of"].get<std::string>() << '\n'
              << "water     field   c    mode      particles s/million   first  B/part.  B/triang.  allocs   mul-add   "
                 "copy\n";
    Rows rows = Rows::array();
    // Written after each row: a run that is cut short leaves what it has measured.
    const auto add = [&](Row row) {
        rows.push_back(std::move(row));
        write_report(options.out, "scaling", summary, rows);
        print(rows.back());
    };
    const auto measure_scene = [&](const std::string& scene, const std::vector<float>& positions) {
        for (const Field field : options.fields)
            for (const double cell_size : options.cell_sizes) {
                if (cell_size <= fine && positions.size() / 3 > options.max_particles_fine) continue;
                for (const Mode mode : {Mode::uniform, Mode::adaptive})
                    add(measure(options, scene, positions, field, cell_size, mode, peaks));
            }
    };
    if (!options.frame.empty()) {
        measure_scene(std::filesystem::path(options.frame).stem(), formats::read_particles(options.frame).positions);
        return;
    }
    for (std::size_t particles = options.min_particles; particles <= options.max_particles; particles *= growth)
        for (const WaterKind kind : choices<WaterKind>)
            measure_scene(std::string(name_of(kind)),
                          make_water(kind, particles, static_cast<float>(options.particle_radius)));
    const Rows comparison = compare_sizes(rows);
    std::cout << "\nper particle, largest over smallest: time, memory\n";
    for (const Row& row : comparison) print_comparison(row);
    summary["largest_against_smallest"] = comparison;
    write_report(options.out, "scaling", summary, rows);
}

}  // namespace

void add_scaling(CLI::App& app) {
    auto options = std::make_shared<ScalingOptions>();
    CLI::App& command = *app.add_subcommand(
        "scaling", "Time and memory from 16 thousand to 16 million particles, and the distance from the floor");
    const CLI::Range at_least_one_basin(basin_particles, std::size_t{1} << 32U);
    command.add_option("--min-particles", options->min_particles, "Smallest scene; the next one has 4 times as many")
        ->check(at_least_one_basin)
        ->capture_default_str();
    command.add_option("--max-particles", options->max_particles, "Largest scene")
        ->check(at_least_one_basin)
        ->capture_default_str();
    command.add_option("--max-particles-fine", options->max_particles_fine, "Largest scene at cell size 0.5")
        ->capture_default_str();
    command
        .add_option_function<std::vector<std::string>>(
            "--fields",
            [options](const std::vector<std::string>& names) {
                options->fields.clear();
                for (const std::string& name : names) options->fields.push_back(by_name<Field>(name, "field"));
            },
            "Any of " + listed(names<Field>))
        ->default_str(std::string(name_of(Settings{}.field)));
    command.add_option("--cell-sizes", options->cell_sizes, "In particle radii")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    add_backend_options(command, options->backend);
    command.add_option("--tolerance", options->tolerance, "Of the curvature criterion, in cells")
        ->default_str("that of the field");
    command.add_option("--repeats", options->limits.runs, "Warm runs of each case, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--seconds-per-case", options->limits.seconds, "No further warm run begins after so long")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.add_option("--frame", options->frame, "File of particles to measure on, in place of generated water")
        ->check(CLI::ExistingFile);
    command.add_option("--particle-radius", options->particle_radius, "World units")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--write-water", options->write_water,
                       "File (VTK) for the splashing water of the largest scene; then nothing is measured");
    command.callback([options] { options->write_water.empty() ? run_scaling(*options) : write_water(*options); });
}

}  // namespace meniscus::benchmarks
