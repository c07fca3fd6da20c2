#include "quality/levels.hpp"

#include <algorithm>

#include "backend_options.hpp"
#include "compare/comparison.hpp"
#include "processor_time.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks::quality {
namespace {

constexpr std::size_t samples = 200'000;  ///< those of `meniscus compare`
constexpr int heights = 8;
constexpr double height_step = 0.5;  ///< cells

Settings in_mode(Settings settings, Mode mode) {
    settings.mode = mode;
    return settings;
}

/// One field in both modes.
struct Pair {
    explicit Pair(const Settings& settings)
        : uniform(reconstructing(in_mode(settings, Mode::uniform))),
          adaptive(reconstructing(in_mode(settings, Mode::adaptive))) {
        both = {adaptive.field, "adaptive/uniform", settings.cell_size, {}};
    }
    Method uniform;
    Method adaptive;
    Method both;  ///< the name of the two in rows about both
};

Cloud move_up(const Cloud& frame, double distance) {
    Cloud moved = frame;
    for (std::size_t i = 1; i < moved.positions.size(); i += 3)
        moved.positions[i] = static_cast<float>(static_cast<double>(moved.positions[i]) + distance);
    return moved;
}

double triangle_ratio(const Surface& adaptive, const Surface& uniform) {
    return static_cast<double>(adaptive.triangles.size()) / static_cast<double>(uniform.triangles.size());
}

/// One reconstruction after the other, of the same frame.
struct TimedRuns {
    explicit TimedRuns(const Settings& settings) : reconstructor(settings, one_cpu_thread) {}

    void run(const Cloud& frame) {
        const double begin = thread_seconds();
        reconstructor.reconstruct(frame.frame(), mesh);
        milliseconds.push_back(1e3 * (thread_seconds() - begin));
    }

    Reconstructor reconstructor;
    Mesh mesh;
    std::vector<double> milliseconds;
};

}  // namespace

void measure_levels(const std::vector<Settings>& fields, const std::vector<Cloud>& frames, Figures& figures) {
    for (const Settings& field : fields) {
        const Pair pair(field);
        for (const Cloud& frame : frames) {
            const Surface adaptive = pair.adaptive.surface_of(frame);
            const Surface uniform = pair.uniform.surface_of(frame);
            const compare::Comparison compared = compare::compare_surfaces(adaptive.view(), uniform.view(), samples);
            const compare::DistanceSummary distance = compared.distance();
            figures.add({"levels", frame.name, ""}, pair.both,
                        {{"triangle_ratio", triangle_ratio(adaptive, uniform)},
                         {"percentile_99_cells", distance.percentile_99 / field.cell_size},
                         {"max_cells", distance.max / field.cell_size},
                         {"lost_components", static_cast<double>(compared.b.missing(field.cell_size).size())}});
        }
    }
}

void measure_heights_on_lattice(const std::vector<Settings>& fields, const Cloud& frame, Figures& figures) {
    for (const Settings& field : fields) {
        const Pair pair(field);
        std::vector<Figure> ratios;
        double worst = 0.0;
        for (int i = 0; i < heights; ++i) {
            const Cloud moved = move_up(frame, height_step * i * world_cell_size(field));
            const double ratio = triangle_ratio(pair.adaptive.surface_of(moved), pair.uniform.surface_of(moved));
            ratios.push_back({"step_" + std::to_string(i), ratio});
            worst = std::max(worst, ratio);
        }
        ratios.insert(ratios.begin(), {"worst_triangle_ratio", worst});
        figures.add({"heights", frame.name, ""}, pair.both, ratios);
    }
}

void measure_times(const std::vector<Settings>& fields, const std::vector<Cloud>& frames, unsigned runs,
                   Figures& figures) {
    for (const Cloud& frame : frames) {
        std::vector<TimedRuns> timed;
        for (const Settings& field : fields)
            for (const Mode mode : {Mode::uniform, Mode::adaptive}) timed.emplace_back(in_mode(field, mode));
        for (TimedRuns& t : timed) {
            t.run(frame);
            t.milliseconds.clear();
        }
        for (unsigned i = 0; i < runs; ++i)
            for (TimedRuns& t : timed) t.run(frame);
        double color = 0.0;  // of the adaptive mode
        for (std::size_t i = 0; i < fields.size(); ++i)
            if (fields[i].field == Field::color) color = median(timed[2 * i + 1].milliseconds);
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const double uniform = median(timed[2 * i].milliseconds);
            const double adaptive = median(timed[2 * i + 1].milliseconds);
            std::vector<Figure> found{{"uniform_milliseconds", uniform},
                                      {"adaptive_milliseconds", adaptive},
                                      {"adaptive_over_uniform", adaptive / uniform}};
            if (color > 0.0) found.push_back({"adaptive_over_adaptive_color", adaptive / color});
            figures.add({"times", frame.name, ""}, Pair(fields[i]).both, found);
        }
    }
}

}  // namespace meniscus::benchmarks::quality
