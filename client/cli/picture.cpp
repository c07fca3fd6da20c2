// meniscus picture: a mesh file to a PNG.
#include "cli/picture.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.hpp"
#include "cli/options/named_option.hpp"

namespace meniscus::cli {
namespace {

constexpr std::size_t largest_side = 8192;

struct PictureCommand {
    std::string mesh;
    std::string out;
    std::vector<double> view;
    PictureOptions options;
};

void picture(PictureCommand command) {
    if (!command.view.empty()) {
        command.options.azimuth = command.view[0];
        command.options.elevation = command.view[1];
    }
    formats::write_png(command.out, draw_picture(formats::read_mesh(command.mesh), command.options));
}

}  // namespace

void add_picture(CLI::App& app) {
    auto options = std::make_shared<PictureCommand>();
    CLI::App& command = *app.add_subcommand("picture", "Draw a mesh file");
    command.add_option("MESH", options->mesh, ".ply, .obj or .bricks")->required();
    command.add_option("-o,--output", options->out, "PNG file")->required();
    command.add_flag("--wireframe", options->options.wireframe,
                     "Lines colored by level (1 blue, 2 green, 3 red, crack filling purple), hidden lines removed");
    command.add_option("--width", options->options.width, "Pixels")
        ->check(CLI::Range(std::size_t{1}, largest_side))
        ->capture_default_str();
    command.add_option("--height", options->options.height, "Pixels")
        ->check(CLI::Range(std::size_t{1}, largest_side))
        ->capture_default_str();
    command.add_option("--view", options->view, "AZIMUTH ELEVATION: where the viewer stands, degrees (default 30 25)")
        ->expected(2)
        ->check(CLI::Range(-360.0, 360.0));
    add_named_option(command, "--up", options->options.up, "Axis that points up");
    command.callback([options] { picture(*options); });
}

}  // namespace meniscus::cli
