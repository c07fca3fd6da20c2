// meniscus check: whether mesh files are closed, manifold and consistently oriented.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/sequence/frame_meshes.hpp"
#include "cli/surfaces/mesh_check.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::cli {
namespace {

struct CheckOptions {
    std::vector<std::string> meshes;
    std::optional<MeshFormat> input_format;
    std::optional<std::uint64_t> frame;
    formats::ReadLimits limits;
    Verbosity verbosity;
};

void check(const CheckOptions& options) {
    for (const std::string& path : options.meshes)
        if (!has_frames(path))
            check_named(path, options.input_format.has_value(), "--input-format", formats::read_mesh_formats());
    MeshCheck check;
    const auto look_at = [&](const std::string& name, const formats::TriangleMesh& mesh) {
        const compare::Defects defects = defects_of(mesh);
        check.say(name, defects);
        if (options.verbosity.quiet) return;
        std::cout << visible(name) << ": " << mesh.triangles.size() << " triangles, "
                  << (defects.closed() ? "closed, manifold and consistently oriented" : defects.text()) << '\n';
    };
    for (const std::string& path : options.meshes) {
        if (has_frames(path))
            for_each_frame(path, options.frame ? FrameRange{*options.frame, *options.frame} : FrameRange{},
                           [&](const std::string& name, const client::ReceivedFrame& frame) {
                               look_at(name, formats::to_triangles(frame.mesh()));
                           });
        else
            look_at(formats::input_name(path), formats::read_mesh(path, options.input_format, options.limits));
    }
    check.finish();
}

}  // namespace

void add_check(CLI::App& app) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App& command = *app.add_subcommand(
        "check", "Say whether meshes are closed, manifold and consistently oriented; exit code 4 if one is not");
    {
        const OptionGroup group(command, files_heading);
        command
            .add_option("MESH", options->meshes,
                        "Mesh: " + listed(formats::read_mesh_formats()) +
                            "; - for standard input; a recording or a publication, of which every frame is looked at")
            ->required();
        add_named_option(command, "--input-format", options->input_format,
                         "Format of all of them, whatever their extensions; - needs it");
        add_frame_option(command, options->frame, "all");
    }
    add_read_limits(command, options->limits);
    options->verbosity.add_quiet_to(command);
    add_examples(command, {"meniscus check surface.ply", "meniscus check surface_*.obj && echo all are whole"});
    command.callback([options] { check(*options); });
}

}  // namespace meniscus::cli
