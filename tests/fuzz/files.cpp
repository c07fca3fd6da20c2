#include "formats/brick_file.hpp"
#include "formats/mesh_file.hpp"
#include "formats/particles.hpp"
#include "sample_files.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

namespace {

const std::string name = "input";

/// The well-formed files of the formats' own tests.
Seeds files_of(const std::string& format) {
    Seeds seeds;
    for (const test::Sample& sample : test::samples())
        if (sample.name.starts_with(format)) seeds.push_back(sample.bytes);
    return seeds;
}

void read_particles(formats::Particles (*read)(const std::string&, Bytes), Bytes bytes) {
    may_refuse([&] {
        const formats::Particles particles = read(name, bytes);
        require(particles.positions.size() % 3 == 0, "three coordinates per particle");
        require(particles.levels.empty() || particles.levels.size() == particles.positions.size() / 3,
                "a level per particle or none");
    });
}

void read_mesh(formats::TriangleMesh (*read)(const std::string&, Bytes), Bytes bytes) {
    may_refuse([&] {
        const formats::TriangleMesh mesh = read(name, bytes);
        require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal per vertex or none");
        for (const Triangle& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle)
                require(vertex < mesh.positions.size(), "faces name vertices that are there");
    });
}

}  // namespace

void vtk(Bytes bytes) {
    read_particles(formats::read_vtk, bytes);
}
Seeds vtk_seeds() {
    return files_of("vtk");
}

void particle_ply(Bytes bytes) {
    read_particles(formats::read_particle_ply, bytes);
}
Seeds particle_ply_seeds() {
    return files_of("particle ply");
}

void xyz(Bytes bytes) {
    read_particles(formats::read_xyz, bytes);
}
Seeds xyz_seeds() {
    return files_of("xyz");
}

void mesh_ply(Bytes bytes) {
    read_mesh(formats::read_mesh_ply, bytes);
}
Seeds mesh_ply_seeds() {
    return files_of("mesh ply");
}

void mesh_obj(Bytes bytes) {
    read_mesh(formats::read_obj, bytes);
}
Seeds mesh_obj_seeds() {
    return files_of("mesh obj");
}

void brick_file(Bytes bytes) {
    may_refuse([&] {
        const client::ReceivedFrame frame = formats::read_bricks(name, bytes);
        may_refuse([&] { (void)frame.mesh(); });
    });
}
Seeds brick_file_seeds() {
    return files_of("bricks");
}

}  // namespace meniscus::fuzz
