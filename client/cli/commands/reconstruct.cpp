// meniscus reconstruct: particle files to mesh files.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/commands/reconstruct_plan.hpp"
#include "cli/commands/reconstruct_report.hpp"
#include "cli/options/box_option.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/sequence/jobs.hpp"
#include "cli/sequence/work_in_turn.hpp"
#include "cli/surfaces/array_forms.hpp"
#include "cli/surfaces/particle_input.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

constexpr unsigned most_at_a_time = 256;

struct ReconstructOptions {
    ReconstructFiles files;
    double particle_radius = 0.0;
    SettingsOptions settings;
    SurfacesOptions surfaces;
    std::optional<Box> particle_box;
    PositionEncoding positions = PositionEncoding::float32;
    unsigned repeat = 1;
    std::optional<unsigned> jobs;
    ReportOptions report;

    bool is_local() const { return surfaces.server.address.empty(); }
    ParticleInputOptions input() const {
        return {files.input_format, files.limits, particle_box, report.edits.origin, positions};
    }
    /// Relative to the origin, as the particles are.
    Settings settings_in_place() const {
        Settings out = settings.build(particle_radius);
        for (std::size_t a = 0; a < 3 && out.domain && report.edits.origin; ++a) {
            out.domain->min[a] -= (*report.edits.origin)[a];
            out.domain->max[a] -= (*report.edits.origin)[a];
        }
        return out;
    }
};

/// The frames of a plan, in this process or on a server.
class Reconstruction {
public:
    Reconstruction(const ReconstructOptions& options, const Plan& plan, const Settings& settings,
                   ReconstructReport& report)
        : options_(options), plan_(plan), settings_(settings), report_(report) {}

    void run_here();
    void run_on_server();

private:
    class Worker;

    std::unique_ptr<ParticleInput> read(std::size_t index) const {
        return std::make_unique<ParticleInput>(plan_.frames[index].in, options_.input(), settings_);
    }
    unsigned jobs() const;
    /// Where this plan's surfaces come from.
    SurfacesOptions place() const;
    /// All attributes are those of the first frame with particles, whichever worker has it, and if it is skipped.
    void name_attributes();

    const ReconstructOptions& options_;
    const Plan& plan_;
    Settings settings_;
    ReconstructReport& report_;
    ArrayForms forms_;  ///< of the frames that have had their turn
};

/// One frame at a time in this process, by a reconstructor of its own.
class Reconstruction::Worker {
public:
    Worker(Reconstruction& whole, const SurfacesOptions& surfaces)
        : whole_(whole), surfaces_(surfaces.open(whole.settings_, [this](Surface& surface) { handle(surface); })) {}

    void work(std::size_t index, const std::function<void()>& wait_for_turn) {
        const auto input = whole_.read(index);
        index_ = index;
        const std::string name = formats::input_name(whole_.plan_.frames[index].in);
        try {
            for (unsigned run = 0; run < whole_.options_.repeat; ++run)
                surfaces_->submit(input->frame(), whole_.plan_.frames[index].time);
            finished_.warnings = input->warnings();
            wait_for_turn();
            whole_.forms_.require(input->frame().arrays);
        } catch (const InvalidInput& e) {
            throw InvalidInput(name + ": " + e.what());
        } catch (const LimitExceeded& e) {
            throw LimitExceeded(name + ": " + e.what());
        }
        whole_.report_.deliver(std::move(finished_));
    }

private:
    void handle(Surface& surface) {
        runs_.push_back(surface.statistics());
        whole_.report_.say_run(runs_.size(), whole_.options_.repeat, runs_.back());
        if (runs_.size() == whole_.options_.repeat)
            finished_ = whole_.report_.prepare(surface, index_, std::exchange(runs_, {}));
    }

    Reconstruction& whole_;
    std::unique_ptr<Surfaces> surfaces_;
    std::size_t index_ = 0;
    std::vector<Statistics> runs_;
    FinishedFrame finished_;
};

unsigned threads_of(const BackendOptions& backend) {
    return backend.threads != 0 ? backend.threads : std::max(1U, std::thread::hardware_concurrency());
}

unsigned Reconstruction::jobs() const {
    if (options_.repeat > 1) return 1;          // what is measured is not disturbed
    if (options_.surfaces.parts > 1) return 1;  // a frame in parts leaves no memory for others
    const BackendOptions& backend = options_.surfaces.backend;
    if (describe_backend(backend.backend, backend.device).backend == Backend::cuda) return 1;
    JobsInput input{.frames = plan_.frames.size(), .threads = threads_of(backend)};
    for (const FrameFiles& frame : plan_.frames) {
        std::error_code error;  // of a file that is not there, which is an error when it is read
        const std::uint64_t bytes = std::filesystem::file_size(frame.in, error);
        if (!error) input.file_bytes = std::max(input.file_bytes, bytes);
    }
    input.memory_bytes =
        static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return jobs_of(input, options_.jobs);
}

void Reconstruction::name_attributes() {
    for (const FrameFiles& frame : plan_.all) {
        const ParticleInput input(frame.in, options_.input(), settings_);
        if (input.frame().count() == 0) continue;
        for (const ParticleArray& array : input.frame().arrays) settings_.attributes.emplace_back(array.name);
        break;
    }
    settings_.all_attributes = false;
}

SurfacesOptions Reconstruction::place() const {
    SurfacesOptions place = options_.surfaces;
    place.bricks = plan_.format == MeshFormat::bricks && !options_.files.out.empty();
    return place;
}

void Reconstruction::run_here() {
    const unsigned count = jobs();
    if (plan_.all.size() > 1 && settings_.all_attributes) name_attributes();
    SurfacesOptions surfaces = place();
    surfaces.only_one = plan_.frames.size() * options_.repeat == 1;
    if (count > 1) surfaces.backend.threads = std::max(1U, threads_of(surfaces.backend) / count);
    std::vector<std::unique_ptr<Worker>> workers;
    std::vector<Work> works;
    for (unsigned i = 0; i < count; ++i) {
        workers.push_back(std::make_unique<Worker>(*this, surfaces));
        works.emplace_back([worker = workers.back().get()](std::size_t index, const std::function<void()>& wait) {
            worker->work(index, wait);
        });
    }
    work_in_turn(plan_.frames.size(), works);
}

void Reconstruction::run_on_server() {
    std::vector<std::vector<FileWarning>> warnings(plan_.frames.size());  // each is there before its frame is submitted
    std::vector<Statistics> runs;
    if (plan_.frames.size() < plan_.all.size() && settings_.all_attributes) name_attributes();
    SurfacesOptions there = place();
    there.stream.spray = settings_.spray == Spray::points;
    const auto surfaces = there.open(settings_, [&](Surface& surface) {
        runs.push_back(surface.statistics());
        report_.say_run(runs.size(), options_.repeat, runs.back());
        if (runs.size() < options_.repeat) return;
        const std::size_t index = surface.index() / options_.repeat;
        FinishedFrame finished = report_.prepare(surface, index, std::exchange(runs, {}));
        finished.warnings = std::move(warnings[index]);
        report_.deliver(std::move(finished));
    });
    for (std::size_t i = 0; i < plan_.frames.size(); ++i) {
        const auto input = read(i);
        warnings[i] = input->warnings();
        for (unsigned run = 0; run < options_.repeat; ++run) surfaces->submit(input->frame(), plan_.frames[i].time);
    }
    surfaces->finish();
}

void reconstruct(const ReconstructOptions& options) {
    const Settings settings = options.settings_in_place();
    if (!options.files.spray_out.empty()) check_spray(settings);
    const Plan plan = make_plan(options.files);
    if (!options.files.out.empty()) options.report.edits.require(plan.format);
    ReportOptions report_options = options.report;
    report_options.bar = options.repeat == 1;
    ReconstructReport report(options.files, plan, report_options);
    Reconstruction reconstruction(options, plan, settings, report);
    if (!plan.frames.empty()) options.is_local() ? reconstruction.run_here() : reconstruction.run_on_server();
    report.finish();
}

void add_place(CLI::App& command, ReconstructOptions& options) {
    {
        const OptionGroup group(command, place_heading);
        add_named_option(command, "--positions", options.positions,
                         "Encoding of the positions; uint16 is over the frame's bounding box");
        command.add_option("--repeat", options.repeat, "Number of times that each frame is reconstructed")
            ->check(CLI::Range(1U, 1000000U))
            ->capture_default_str();
    }
    options.surfaces.add_to(command);
    const OptionGroup group(command, place_heading);
    command
        .add_option("--parts", options.surfaces.parts,
                    "Parts that each frame is reconstructed in, one after the other, for frames that memory does not "
                    "hold as a whole; meshes do not depend on it")
        ->check(CLI::Range(std::size_t{1}, max_parts))
        ->capture_default_str()
        ->excludes(command.get_option("--server"));
    command
        .add_option("--jobs", options.jobs,
                    "Frames of a sequence that are reconstructed at a time, which share the threads; meshes do not "
                    "depend on it. Default: one per thread, at most 8, as the memory allows; one on a GPU")
        ->check(CLI::Range(1U, most_at_a_time))
        ->excludes(command.get_option("--server"))
        ->excludes(command.get_option("--repeat"));
}

}  // namespace

void add_reconstruct(CLI::App& app) {
    auto options = std::make_shared<ReconstructOptions>();
    CLI::App& command = *app.add_subcommand("reconstruct", "Reconstruct the surface of particle files");
    options->files.add_to(command);
    {
        const OptionGroup group(command, surface_heading);
        command.add_option("-r,--particle-radius", options->particle_radius, "World units")->required();
        add_box_option(command, "--particle-aabb", options->particle_box,
                       "X0 Y0 Z0 X1 Y1 Z1: particles outside of this box are left out of the frame, world units");
        command
            .add_option_function<std::vector<double>>(
                "--origin",
                [options](const std::vector<double>& at) {
                    options->report.edits.origin = {at[0], at[1], at[2]};
                },
                "X Y Z, world units, for coordinates far from 0: subtracted from float64 positions before they are "
                "rounded to float32, and added to the mesh, which gets float64 positions")
            ->expected(3);
    }
    options->settings.add_to(command);
    options->settings.add_attribute_to(command);
    options->files.add_sequence_to(command);
    options->report.edits.add_to(command);
    {
        const OptionGroup group(command, mesh_heading);
        command.add_flag("--check", options->report.check,
                         "Exit code 4 unless every mesh is closed, manifold and consistently oriented, with a line for "
                         "each kind of defect; all output is written all the same");
    }
    add_place(command, *options);
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->report.strict);
    }
    options->report.verbosity.add_to(command);
    const char* const in_a_pipe =
        "zcat frame.vtk.gz | meniscus reconstruct - --input-format vtk -o - --format ply -r 0.025 | "
        "meniscus picture - --input-format ply -o surface.png";
    add_examples(command, {"meniscus reconstruct frame.vtk -o surface.ply --particle-radius 0.025",
                           "meniscus reconstruct 'frame_{}.vtk' -o 'mesh_{}.ply' -r 0.025 --cell-size 1 --step 2",
                           "meniscus reconstruct 'frame_{}.vtk' -o 'mesh_{}.ply' -r 0.025 --skip-existing",
                           "meniscus reconstruct frame.vtk -o surface.ply -r 0.025 --server localhost", in_a_pipe});
    command.callback([options] { reconstruct(*options); });
}

}  // namespace meniscus::cli
