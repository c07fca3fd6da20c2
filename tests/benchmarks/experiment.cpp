// meniscus-bench experiment: the paper's comparison of uniform and adaptive grids (its Figure 8).
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

#include "backend_options.hpp"
#include "benchmarks.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "line_plot.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "report.hpp"
#include "simulator/simulation.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks {
namespace {

struct ExperimentOptions {
    std::size_t particles = 16000;
    std::size_t frames = 500;
    double frame_seconds = 0.005;
    unsigned repeats = 1;
    BackendOptions backend = one_cpu_thread;
    Settings settings;
    std::optional<double> tolerance;
    std::string out = "tests/benchmarks/results";
};

constexpr std::array<Mode, 2> modes{Mode::uniform, Mode::adaptive};

/// One mode's reconstructor, and what it did for every frame.
struct Series {
    Series(const Settings& settings, const BackendOptions& options) : reconstructor(settings, options) {}

    Reconstructor reconstructor;
    Mesh mesh;
    std::vector<Statistics> runs;    ///< runs of the frame in work
    std::vector<Statistics> frames;  ///< its median runs

    void run(const ParticleFrame& frame) {
        reconstructor.reconstruct(frame, mesh);
        runs.push_back(reconstructor.statistics());
    }
    void end_frame() {
        std::stable_sort(runs.begin(), runs.end(),
                         [](const Statistics& a, const Statistics& b) { return a.total_seconds < b.total_seconds; });
        frames.push_back(runs[(runs.size() - 1) / 2]);
        runs.clear();
    }
    std::vector<double> figures(const auto& of) const {
        std::vector<double> out;
        for (const Statistics& s : frames) out.push_back(static_cast<double>(of(s)));
        return out;
    }
};

using BothSeries = std::array<std::unique_ptr<Series>, modes.size()>;

constexpr auto milliseconds = [](const Statistics& s) { return 1e3 * reconstruction_seconds(s); };
constexpr auto thousand_triangles = [](const Statistics& s) { return 1e-3 * static_cast<double>(s.triangles); };

BothSeries simulate(const ExperimentOptions& options, const simulator::Scene& scene) {
    Settings settings = options.settings;
    settings.criterion = CurvatureCriterion{options.tolerance};
    settings.particle_radius = static_cast<double>(scene.particle_radius);
    BothSeries series;
    for (std::size_t m = 0; m < modes.size(); ++m) {
        settings.mode = modes[m];
        series[m] = std::make_unique<Series>(settings, options.backend);
    }

    simulator::Simulation simulation(scene);
    for (std::size_t i = 0; i < options.frames; ++i) {
        simulation.advance(options.frame_seconds);
        const std::vector<float> positions = simulation.positions();
        ParticleFrame frame;
        frame.positions = positions;
        if (i == 0) {  // so that every measured run is a warm one
            for (const auto& s : series) s->reconstructor.reconstruct(frame, s->mesh);
        }
        for (unsigned repeat = 0; repeat < options.repeats; ++repeat)
            for (const auto& s : series) s->run(frame);
        for (const auto& s : series) s->end_frame();
        if ((i + 1) % 50 == 0) std::cerr << i + 1 << " of " << options.frames << " frames\n";
    }
    return series;
}

/// Adaptive against uniform, over all frames.
nlohmann::ordered_json summarize(const BothSeries& series) {
    nlohmann::ordered_json summary;
    const auto compare = [&](const std::string& name, const auto& of) {
        const std::vector<double> uniform = series[0]->figures(of);
        const std::vector<double> adaptive = series[1]->figures(of);
        std::vector<double> ratios;
        std::size_t above = 0;
        for (std::size_t i = 0; i < uniform.size(); ++i) {
            ratios.push_back(uniform[i] > 0.0 ? adaptive[i] / uniform[i] : 1.0);
            if (adaptive[i] > uniform[i]) ++above;
        }
        nlohmann::ordered_json& figures = summary[name];
        figures["uniform_median"] = median(uniform);
        figures["adaptive_median"] = median(adaptive);
        figures["ratio_median"] = median(ratios);
        figures["ratio_min"] = *std::min_element(ratios.begin(), ratios.end());
        figures["ratio_max"] = *std::max_element(ratios.begin(), ratios.end());
        figures["frames_adaptive_above_uniform"] = above;
    };
    compare("milliseconds", milliseconds);
    compare("thousand_triangles", thousand_triangles);
    compare("field_evaluations", [](const Statistics& s) { return s.field_evaluations; });
    return summary;
}

void write_plots(const std::filesystem::path& directory, const BothSeries& series) {
    std::vector<double> frames;
    for (std::size_t i = 0; i < series[0]->frames.size(); ++i) frames.push_back(static_cast<double>(i + 1));
    const Series& adaptive = *series[1];
    const auto write = [&](const char* file, const char* title, const char* unit, std::vector<Line> lines) {
        formats::write_file(directory / file, to_svg({title, "frame", unit, frames, std::move(lines)}));
    };
    const auto both = [&](const auto& of) {
        return std::vector<Line>{{std::string(name_of(modes[0])), series[0]->figures(of)},
                                 {std::string(name_of(modes[1])), series[1]->figures(of)}};
    };
    constexpr const char* time_unit = "milliseconds, warm";
    constexpr const char* triangle_unit = "thousand triangles";
    write("experiment-a-time.svg", "(a) Time of reconstruction", time_unit, both(milliseconds));
    write("experiment-b-triangles.svg", "(b) Triangles", triangle_unit, both(thousand_triangles));

    std::vector<Line> stages;
    for (std::size_t i = 0; i < stage_count; ++i) {
        std::string name(names<Stage>[i]);
        std::replace(name.begin(), name.end(), '_', ' ');
        stages.push_back({name, adaptive.figures([i](const Statistics& s) { return 1e3 * s.stage_seconds[i]; })});
    }
    write("experiment-c-stages.svg", "(c) Time of each step, adaptive", time_unit, std::move(stages));

    constexpr std::array<const char*, triangle_level_count> level_names{"level 1", "level 2", "level 3",
                                                                        "crack filling"};
    std::vector<Line> levels;
    for (std::size_t i = 0; i < triangle_level_count; ++i)
        levels.push_back({level_names[i], adaptive.figures([i](const Statistics& s) {
                              return 1e-3 * static_cast<double>(s.triangles_by_level[i]);
                          })});
    write("experiment-d-levels.svg", "(d) Triangles of each level, adaptive", triangle_unit, std::move(levels));
}

void run_experiment(const ExperimentOptions& options) {
    const simulator::Scene scene = simulator::make_scene(simulator::SceneKind::dam_break, options.particles);
    const BothSeries series = simulate(options, scene);
    Rows rows = Rows::array();
    for (std::size_t i = 0; i < options.frames; ++i)
        for (std::size_t m = 0; m < modes.size(); ++m) {
            Row row{{"frame", i + 1}, {"mode", name_of(modes[m])}};
            add_statistics(row, series[m]->frames[i]);
            rows.push_back(std::move(row));
        }
    nlohmann::ordered_json summary;
    summary["runs"] = "warm; median of " + std::to_string(options.repeats) + ", modes alternating";
    add_backend(summary, options.backend);
    summary["particles"] = options.particles;
    summary["cell_size"] = options.settings.cell_size;
    summary["tolerance"] = options.tolerance.value_or(tolerance(options.settings));
    summary["adaptive_against_uniform"] = summarize(series);
    write_report(options.out, "experiment", summary, rows);
    write_plots(options.out, series);
    std::cout << summary["adaptive_against_uniform"].dump(2) << '\n';
}

}  // namespace

void add_experiment(CLI::App& app) {
    auto options = std::make_shared<ExperimentOptions>();
    CLI::App& command = *app.add_subcommand(
        "experiment", "The paper's dam break, uniform against adaptive: its Figure 8 as CSV and as plots");
    command.add_option("--particles", options->particles, "Number of particles; the paper's is the default")
        ->capture_default_str();
    command.add_option("--frames", options->frames, "Number of frames")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}))
        ->capture_default_str();
    command
        .add_option("--frame-seconds", options->frame_seconds,
                    "Simulated time between two frames; the paper's time step")
        ->check(CLI::Range(1e-4, 1.0))
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Runs of each frame and mode, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    add_backend_options(command, options->backend);
    command.add_option("--cell-size", options->settings.cell_size, "In particle radii")->capture_default_str();
    command.add_option("--tolerance", options->tolerance, "Of the curvature criterion, in cells")
        ->default_str("that of the field");
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_experiment(*options); });
}

}  // namespace meniscus::benchmarks
