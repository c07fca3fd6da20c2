#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/containers/pysph_npz.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/recordings/brick_file.hpp"
#include "sample_files.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

namespace {

const std::string name = "input";
/// A thousand times the longest input.
constexpr formats::ReadLimits limits{.most_bytes = std::uint64_t{64} << 20};

/// The well-formed files of the formats' own tests.
Seeds files_of(const std::string& format) {
    Seeds seeds;
    for (const test::Sample& sample : test::samples())
        if (sample.name.starts_with(format)) seeds.push_back(sample.bytes);
    return seeds;
}

void require_values(const std::vector<formats::NamedValues>& arrays, std::size_t count) {
    require(arrays.size() <= max_particle_arrays, "no more arrays than a frame has");
    for (const formats::NamedValues& array : arrays) {
        require(can_be_attribute(array.type, array.components), "forms of attributes");
        require(array.data.size() == count * array.element_bytes(), "a value for each");
    }
}

/// read: a reader of (name, bytes, limits).
template <class Read>
void read_particles(const Read& read, Bytes bytes) {
    may_refuse([&] {
        const formats::Particles particles = read(name, bytes, limits);
        require(particles.positions.size() % 3 == 0, "three coordinates per particle");
        require(particles.levels.empty() || particles.levels.size() == particles.positions.size() / 3,
                "a level per particle or none");
        require_values(particles.arrays, particles.count());
    });
}

template <class Read>
void read_mesh(const Read& read, Bytes bytes) {
    may_refuse([&] {
        const formats::TriangleMesh mesh = read(name, bytes, limits);
        require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal per vertex or none");
        for (const Triangle& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle)
                require(vertex < mesh.positions.size(), "faces name vertices that are there");
        require(mesh.levels.empty() || mesh.levels.size() == mesh.triangles.size(), "a level per triangle or none");
        require_values(mesh.attributes, mesh.positions.size());
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

void vtk_xml(Bytes bytes) {
    read_particles(formats::read_vtk_xml, bytes);
}
Seeds vtk_xml_seeds() {
    return files_of("xml");
}

void npy(Bytes bytes) {
    read_particles(formats::read_npy, bytes);
}
Seeds npy_seeds() {
    return files_of("npy");
}

void npz(Bytes bytes) {
    read_particles(formats::read_npz, bytes);
}
Seeds npz_seeds() {
    return files_of("npz");
}

void bgeo(Bytes bytes) {
    read_particles(formats::read_bgeo, bytes);
}
Seeds bgeo_seeds() {
    return files_of("bgeo");
}

void particle_json(Bytes bytes) {
    read_particles(formats::read_particle_json, bytes);
}
Seeds particle_json_seeds() {
    return files_of("json");
}

void bi4(Bytes bytes) {
    read_particles(formats::read_bi4, bytes);
}
Seeds bi4_seeds() {
    return files_of("bi4");
}

void pickle(Bytes bytes) {
    may_refuse([&] {
        const formats::ByteCursor at(name, {});
        formats::ReadBudget budget(limits, 0, at);
        for (const formats::NamedNpyArray& array : formats::pysph_arrays(at, bytes, budget))
            for (std::size_t i = 0; array.array.unread.empty() && i < array.array.shape.at(0); ++i)
                (void)array.array.at(i, 0);
    });
}
Seeds pickle_seeds() {
    return files_of("pickle");
}

void mesh_vtk(Bytes bytes) {
    read_mesh(formats::read_mesh_vtk, bytes);
}
Seeds mesh_vtk_seeds() {
    return files_of("mesh vtk");
}

void mesh_vtp(Bytes bytes) {
    read_mesh(formats::read_mesh_vtp, bytes);
}
Seeds mesh_vtp_seeds() {
    return files_of("mesh vtp");
}

void mesh_npz(Bytes bytes) {
    read_mesh(formats::read_mesh_npz, bytes);
}
Seeds mesh_npz_seeds() {
    return files_of("mesh npz");
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
