#include "cli/commands/reconstruct_plan.hpp"

#include <CLI/CLI.hpp>

#include "cli/options/named_option.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/sequence/distinct_files.hpp"
#include "cli/sequence/file_pattern.hpp"
#include "formats/bytes/extension.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

std::vector<FrameFiles> frames_of(const ReconstructFiles& files) {
    FilePattern in(files.in);
    FilePattern out(files.out);
    FilePattern spray_out(files.spray_out);
    const bool sequence = in.has_number();
    in.require_no_other_notation();
    if (!sequence && files.selection.is_given())
        throw InvalidInput("--start, --end, --step and --skip-missing need {} in IN, which is '" + files.in + "'");
    if (!sequence) refuse_share_of_one(files.share, files.in);
    if (files.share && !files.stats.empty())
        throw InvalidInput("--stats is one file: all shares would write it; give --share or --stats");
    if (!sequence && files.frame_rate)
        throw InvalidInput("--frame-rate gives the frames of a sequence their times: it needs {} in IN, which is '" +
                           files.in + "'");
    if (!files.out.empty() && out.has_number() != sequence)
        throw InvalidInput("IN '" + files.in + "' and OUT '" + files.out + "' must both have {} or both not");
    if (!files.spray_out.empty() && spray_out.has_number() != sequence)
        throw InvalidInput("IN '" + files.in + "' and --spray-out '" + files.spray_out +
                           "' must both have {} or both not");
    if (!sequence) return {{.in = files.in, .out = files.out, .spray_out = files.spray_out}};
    std::vector<FrameFiles> frames;
    const auto inputs = files.selection.files(in);
    out.pad_like(in);
    spray_out.pad_like(in);
    frames.reserve(inputs.size());
    for (const auto& [number, path] : inputs)
        frames.push_back({number, path, out.at(number), spray_out.at(number),
                          files.frame_rate ? static_cast<double>(number) / *files.frame_rate : 0.0});
    return frames;
}

void check_files(const ReconstructFiles& files, Plan& plan) {
    DistinctFiles distinct;
    for (const FrameFiles& frame : plan.all) {
        check_named(frame.in, files.input_format.has_value(), "--input-format", names<ParticleFormat>);
        if (!files.input_format) formats::particle_format_of(frame.in);
        distinct.add_input(frame.in);
    }
    // Files of the sequence that are not among the frames are somebody's input, too.
    if (plan.sequence)
        for (const auto& [number, path] : FilePattern(files.in).match_existing()) distinct.add_input(path);
    for (const FrameFiles& frame : plan.all) {
        if (!frame.out.empty()) {
            plan.format = check_mesh_path(frame.out, files.format);
            distinct.add_output(frame.out);
        }
        if (!frame.spray_out.empty()) {
            check_points_path(frame.spray_out);
            distinct.add_output(frame.spray_out);
        }
    }
    for (const std::string& file : {files.stats, files.pvd, files.usd_stage}) {
        check_folder(file);
        if (!file.empty()) distinct.add_output(file);
    }
}

/// file: that lists the meshes of a sequence, which are of this format; empty: not asked for.
void check_list(const std::string& option, const std::string& file, std::string_view extension, MeshFormat format,
                const ReconstructFiles& files, const Plan& plan) {
    if (file.empty()) return;
    if (!plan.sequence || files.out.empty())
        throw InvalidInput(option + " lists the meshes of a sequence: give IN and -o OUT with {}");
    if (files.share)
        throw InvalidInput(option +
                           " lists the whole sequence: once all shares are done, give the same command with "
                           "--skip-existing in place of --share");
    if (plan.format != format)
        throw InvalidInput(option + " lists ." + std::string(name_of(format)) + " files, and the meshes are '" +
                           std::string(name_of(plan.format)) + "'");
    if (formats::lower_extension(file) != extension)
        throw InvalidInput(file + ": the list of a sequence ends in " + std::string(extension));
}

/// Whether there is nothing left to do: files appear whole or not at all.
bool is_done(const FrameFiles& frame) {
    for (const auto& path : {frame.out, frame.spray_out})
        if (!path.empty() && !std::filesystem::is_regular_file(path)) return false;
    return true;
}

}  // namespace

void ReconstructFiles::add_to(CLI::App& command) {
    {
        const OptionGroup group(command, files_heading);
        command
            .add_option(
                "IN", in,
                "Particles: " + listed(formats::particle_extensions()) +
                    "; a sequence with {} or {:03} for the frame number ({} also finds zero-padded names); - for "
                    "standard input")
            ->required();
        command.add_option(
            "-o,--output", out,
            "Mesh: " + listed(formats::mesh_extensions()) + "; with {} for a sequence; - for standard output");
        add_named_option(command, "--input-format", input_format,
                         "Format of IN, whatever its extension; - needs it. xyz: float32 triples");
        add_named_option(command, "--format", format, "Format of OUT, whatever its extension; - needs it");
        command.add_option(
            "--spray-out", spray_out,
            "With --spray points: the particles left out of the surface, as PLY; with {} for a sequence");
        command.add_option("--stats", stats, "Figures of each frame, as JSON");
    }
    add_read_limits(command, limits);
}

void ReconstructFiles::add_sequence_to(CLI::App& command) {
    selection.add_to(command);
    add_share_option(command, share);
    const OptionGroup group(command, sequence_heading);
    command.add_flag("--skip-existing", skip_existing,
                     "Leave the frames alone whose outputs are all there: a run that was interrupted goes on");
    command
        .add_option(
            "--frame-rate", frame_rate,
            "Frames per second: frame number N, on a server and in .bricks, has the time N / RATE in place of 0")
        ->type_name("RATE")
        ->check(number_range(0.001, 1e6).description(""));
    command.add_option("--pvd", pvd, "With .vtp: list the sequence for ParaView in this .pvd, frame numbers as times");
    command.add_option("--usd-stage", usd_stage,
                       "With .usda: a stage that shows the sequence by value clips, frame numbers as time codes");
}

Plan make_plan(const ReconstructFiles& files) {
    if (files.out.empty() && files.spray_out.empty() && files.stats.empty())
        throw InvalidInput("nothing to write: give -o OUT, --spray-out FILE.ply, --stats FILE.json or several of them");
    if (files.format && files.out.empty()) throw InvalidInput("--format is that of OUT: give -o OUT");
    if (files.skip_existing && files.out.empty() && files.spray_out.empty())
        throw InvalidInput("--skip-existing looks for the outputs of each frame: give -o OUT or --spray-out");
    Plan plan;
    plan.sequence = FilePattern(files.in).has_number();
    plan.all = frames_of(files);
    check_files(files, plan);
    check_list("--pvd", files.pvd, ".pvd", MeshFormat::vtp, files, plan);
    check_list("--usd-stage", files.usd_stage, ".usda", MeshFormat::usda, files, plan);
    plan.frames = plan.all;
    if (files.share) files.share->keep(plan.frames);
    if (files.skip_existing) plan.skipped = std::erase_if(plan.frames, is_done);
    // A stage says what its frames have, which one that is made tells.
    if (plan.frames.empty() && !files.usd_stage.empty()) {
        plan.frames.push_back(plan.all.front());
        --plan.skipped;
    }
    return plan;
}

}  // namespace meniscus::cli
