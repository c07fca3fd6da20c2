#include "cli/surfaces/mesh_edits.hpp"

#include <CLI/CLI.hpp>
#include <string>

#include "cli/options/box_option.hpp"
#include "cli/options/option_group.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

using formats::is_compressible;
using formats::MeshFormat;

}  // namespace

void add_triangle_levels_flag(CLI::App& command, bool& without_levels) {
    command.add_flag("--no-triangle-levels", without_levels,
                     "Leave out the level of each triangle, over which meshio stumbles in .ply");
}

void MeshEdits::add_to(CLI::App& command) {
    const OptionGroup group(command, mesh_heading);
    add_box_option(command, "--mesh-aabb", box,
                   "X0 Y0 Z0 X1 Y1 Z1: triangles without a corner in this box are left out of the file, world units");
    command.add_flag("--quads", quads,
                     "Merge pairs of triangles that make a good quadrilateral: .obj, .vtk, .vtp, .vtu");
    add_triangle_levels_flag(command, without_levels);
    command.add_flag("--compress", compress,
                     "Smaller files: .glb by Draco (positions on 2^16 steps over the mesh), .vtp and .vtu by zlib");
}

void MeshEdits::require(MeshFormat format) const {
    const std::string name(name_of(format));
    if (quads && !row_of(format).traits.quads)
        throw InvalidInput("--quads needs a format with quadrilaterals, obj, vtk, vtp or vtu, not " + name);
    if (compress && !is_compressible(format))
        throw InvalidInput("--compress needs a format that can be compressed, glb, vtp or vtu, not " + name);
    if (without_levels && format == MeshFormat::bricks)
        throw InvalidInput("--no-triangle-levels leaves out what a file of bricks is made of: name another format");
    if (origin && format == MeshFormat::bricks)
        throw InvalidInput(
            "--origin moves the mesh off the lattice that a file of bricks lies on: name another format");
    if (box && format == MeshFormat::bricks)
        throw InvalidInput(
            "--mesh-aabb leaves out triangles, and a file of bricks has whole bricks: name another format, "
            "or crop the surface by --domain");
}

}  // namespace meniscus::cli
