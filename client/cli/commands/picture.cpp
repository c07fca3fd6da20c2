// meniscus picture: a mesh file to a PNG.
#include "picture/picture.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/sequence/distinct_files.hpp"
#include "cli/sequence/frame_meshes.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

constexpr std::size_t largest_side = 8192;

struct PictureCommand {
    std::string mesh;
    std::optional<MeshFormat> input_format;
    std::optional<std::uint64_t> frame;
    formats::ReadLimits limits;
    std::string out;
    std::vector<double> view;
    std::vector<double> range;
    PictureOptions options;
};

void picture(PictureCommand command) {
    if (!command.view.empty()) {
        command.options.azimuth = command.view[0];
        command.options.elevation = command.view[1];
    }
    if (!command.range.empty()) {
        command.options.range = ValueRange{command.range[0], command.range[1]};
        if (!(command.range[0] < command.range[1]))
            throw InvalidInput("--range is from " + value_text(command.range[0], 0.0) + " to " +
                               value_text(command.range[1], 0.0) + ", its first number must be less than its second");
    }
    const bool frames = has_frames(command.mesh);
    if (!frames && command.frame)
        throw InvalidInput("--frame is of a recording or a publication, and " + command.mesh + " is a file of a mesh");
    if (!frames)
        check_named(command.mesh, command.input_format.has_value(), "--input-format", formats::read_mesh_formats());
    check_folder(command.out);
    DistinctFiles distinct;
    if (!frames) distinct.add_input(command.mesh);
    distinct.add_output(command.out);
    const formats::TriangleMesh mesh = frames ? formats::to_triangles(frame_of(command.mesh, command.frame).mesh())
                                              : formats::read_mesh(command.mesh, command.input_format, command.limits);
    formats::write_png(command.out, draw_picture(mesh, command.options));
}

void add_files(CLI::App& command, PictureCommand& options) {
    const OptionGroup group(command, files_heading);
    command
        .add_option("MESH", options.mesh,
                    "Mesh: " + listed(formats::read_mesh_formats()) +
                        "; - for standard input; a recording or a publication's folder")
        ->required();
    command.add_option("-o,--output", options.out, "PNG file; - for standard output")->required();
    add_named_option(command, "--input-format", options.input_format,
                     "Format of MESH, whatever its extension; - needs it");
    add_frame_option(command, options.frame, "the newest");
}

}  // namespace

void add_picture(CLI::App& app) {
    auto options = std::make_shared<PictureCommand>();
    CLI::App& command = *app.add_subcommand("picture", "Draw a mesh file");
    add_files(command, *options);
    add_read_limits(command, options->limits);
    const OptionGroup group(command, "Picture");
    command.add_flag("--wireframe", options->options.wireframe,
                     "Lines colored by level (1 blue, 2 green, 3 red, crack filling purple), hidden lines removed");
    CLI::Option* const color = command.add_option(
        "--color", options->options.color,
        "Color the surface by an attribute of its vertices: NAME, or NAME.x, .y, .z, .w; of a vector otherwise its "
        "magnitude. With a legend");
    color->excludes("--wireframe");
    add_named_option(command, "--color-map", options->options.color_map, "Colors of --color")->needs(color);
    command.add_option("--range", options->range, "A,B: values at the ends of the colors (default: those of the mesh)")
        ->delimiter(',')
        ->expected(2)
        ->needs(color);
    command.add_option("--width", options->options.width, "Pixels")
        ->check(CLI::Range(std::size_t{1}, largest_side))
        ->capture_default_str();
    command.add_option("--height", options->options.height, "Pixels")
        ->check(CLI::Range(std::size_t{1}, largest_side))
        ->capture_default_str();
    command.add_option("--view", options->view, "AZIMUTH ELEVATION: where the viewer stands, degrees (default 30 25)")
        ->expected(2)
        ->check(number_range(-360.0, 360.0));
    add_named_option(command, "--up", options->options.up, "Axis that points up");
    add_examples(command, {"meniscus picture surface.ply -o surface.png",
                           "meniscus picture surface.ply -o surface.png --wireframe --up z --view 60 20",
                           "meniscus picture surface.ply -o speed.png --color velocity --color-map magma --range 0,5"});
    command.callback([options] { picture(*options); });
}

}  // namespace meniscus::cli
