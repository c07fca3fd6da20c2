// formats_exchange particles|mesh|compressed|no-levels|pvd IN OUT: reads one format and writes another, for
// exchange_test.py and tests/acceptance/opens-in-paraview. compressed: a mesh as .vtp or .vtu by zlib. no-levels: a
// mesh without those of its triangles. pvd: IN at the times 0 and 0.5.
#include <array>
#include <cstdio>
#include <exception>
#include <string_view>

#include "formats/meshes/mesh_file.hpp"
#include "formats/meshes/pvd_writer.hpp"
#include "formats/particles/particle_file.hpp"

int main(int argc, char** argv) {
    using namespace meniscus::formats;
    if (argc != 4) return 2;
    try {
        const std::string_view what = argv[1];
        if (what == "particles")
            write_particles(argv[3], read_particles(argv[2]), particle_format_of(argv[3]));
        else if (what == "compressed")
            write_mesh(argv[3], read_mesh(argv[2]), mesh_format_of(argv[3]), {.compress = true});
        else if (what == "no-levels") {
            TriangleMesh mesh = read_mesh(argv[2]);
            leave_out_levels(mesh);
            write_mesh(argv[3], mesh, mesh_format_of(argv[3]));
        } else if (what == "pvd")
            write_pvd(argv[3], std::array{PvdEntry{0.0, argv[2]}, PvdEntry{0.5, argv[2]}});
        else
            write_mesh(argv[3], read_mesh(argv[2]), mesh_format_of(argv[3]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
