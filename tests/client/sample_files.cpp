#include "sample_files.hpp"

#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "formats/bgeo_sample.hpp"
#include "formats/bi4_sample.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/pysph_npz.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/pysph_sample.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::test {

using formats::store;

TemporaryDirectory::TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "meniscus-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::optional<std::filesystem::path> data_folder() {
    const char* folder = std::getenv("MENISCUS_DATA");
    if (folder == nullptr || *folder == '\0') return std::nullopt;
    return folder;
}

std::string vtk_binary() {
    constexpr auto big = std::endian::big;
    std::string out = "# vtk DataFile Version 4.1\nsample\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n";
    for (const float x : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) store(out, x, big);
    out += "\nCELLS 2 4\n";
    for (const std::int32_t i : {1, 0, 1, 1}) store(out, i, big);
    out += "\nCELL_TYPES 2\n";
    for (const std::int32_t i : {1, 1}) store(out, i, big);
    out += "\nPOINT_DATA 2\nSCALARS id unsigned_int 1\nLOOKUP_TABLE id_table\n";
    for (const std::uint32_t i : {7U, 8U}) store(out, i, big);
    out += "\nFIELD FieldData 3\nvelocity 3 2 float\n";
    for (int i = 0; i < 6; ++i) store(out, 0.5F, big);
    out += "\nlevel 1 2 int\n";
    for (const std::int32_t i : {0, 3}) store(out, i, big);
    out += "\npressure 1 2 double\n";
    for (const double p : {1.5, 2.5}) store(out, p, big);
    return out + "\n";
}

std::string vtk_ascii() {
    return "# vtk DataFile Version 5.1\nsample\nASCII\nDATASET UNSTRUCTURED_GRID\n\nPOINTS 2 double\n1 2 3 \n4 5 6\n"
           "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n"
           "CELLS 3 2\n\nOFFSETS vtktypeint64\n0 1 2\n\nCONNECTIVITY vtktypeint64\n0 1\n\nCELL_TYPES 2\n1\n1\n\n"
           "POINT_DATA 2\nVECTORS velocity float\n0 0 0 1 1 1\nSCALARS level int\nLOOKUP_TABLE default\n0 3\n";
}

Mesh tetrahedron(std::int32_t origin) {
    Mesh mesh;
    mesh.cell_size = 0.125;
    mesh.offset_bits = 6;
    const std::int32_t o = origin;
    for (const LatticePosition& p : {LatticePosition{o, o, o}, {o + 9, o, o}, {o, o + 9, o}, {o, o, o + 9}})
        mesh.vertices.push_back(p);
    const float s = 1.0F / std::sqrt(3.0F);
    for (const Normal& n : {Normal{-s, -s, -s}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) mesh.normals.push_back(n);
    for (const Triangle& t : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) mesh.triangles.push_back(t);
    for (std::uint32_t i = 0; i < 4; ++i) mesh.levels[i] = {i, 1};
    return mesh;
}

std::string refusal(const std::function<void()>& call) {
    try {
        call();
    } catch (const InvalidInput& e) {
        return e.what();
    }
    return {};
}

namespace {

/// Enough for the samples, and soon used up by what they claim once they are damaged.
constexpr formats::ReadLimits small_limits{.most_bytes = std::uint64_t{1} << 20};

/// VTK's XML as text, with two pieces.
std::string vtu_ascii() {
    const std::string piece =
        "<Piece NumberOfPoints=\"2\" NumberOfCells=\"2\"><Points><DataArray type=\"Float64\" Name=\"Points\" "
        "NumberOfComponents=\"3\" format=\"ascii\">1 2 3 4 5 6</DataArray></Points><Cells><DataArray type=\"Int64\" "
        "Name=\"connectivity\">0 1</DataArray><DataArray type=\"Int64\" Name=\"offsets\">1 2</DataArray><DataArray "
        "type=\"UInt8\" Name=\"types\">1 1</DataArray></Cells><PointData><DataArray type=\"Int32\" Name=\"level\">0 "
        "3</DataArray><DataArray type=\"UInt32\" Name=\"id\">7 8</DataArray></PointData></Piece>";
    return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
           "<UnstructuredGrid>" +
           piece + piece + "</UnstructuredGrid></VTKFile>";
}

/// One array inline, in base64, compressed by zlib.
std::string vtp_inline() {
    return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
           "compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"2\"><Points><DataArray "
           "type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">"
           "AQAAABgAAAAAAAAAGgAAAA==eJxjYGiwZ2BgcAAiIG4A4gVAfMABAClDBCA="
           "</DataArray></Points></Piece></PolyData></VTKFile>";
}

/// A triangle, its arrays appended raw, as VTK writes by default.
std::string vtp_appended() {
    std::string appended;
    const auto add = [&](const auto& numbers) {
        const std::size_t offset = appended.size();
        formats::store(appended, std::uint32_t{sizeof(numbers)});
        for (const auto number : numbers) formats::store(appended, number);
        return " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>";
    };
    const std::string points = add(std::array{0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
    const std::string ids = add(std::array{std::int32_t{5}, std::int32_t{6}, std::int32_t{7}});
    const std::string corners = add(std::array{std::int64_t{0}, std::int64_t{1}, std::int64_t{2}});
    const std::string ends = add(std::array{std::int64_t{3}});
    return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\"><PolyData>"
           "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData><DataArray type=\"Int32\" Name=\"id\"" +
           ids + "</PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\"" + points +
           "</Points><Polys><DataArray type=\"Int64\" Name=\"connectivity\"" + corners +
           "<DataArray type=\"Int64\" Name=\"offsets\"" + ends +
           "</Polys></Piece></PolyData><AppendedData encoding=\"raw\">_" + appended + "</AppendedData></VTKFile>";
}

/// The formats that are read as they are written: particles and meshes with arrays.
void add_written_files(std::vector<Sample>& out, const TemporaryDirectory& directory) {
    const auto bytes_of = [&](const std::string& name) { return formats::read_file(directory / name); };
    const auto limited = [](auto reader) {
        return [reader](const std::string& bytes) { (void)reader("sample", bytes, small_limits); };
    };
    formats::Particles particles;
    particles.positions = {1, 2, 3, 4, 5, 6};
    particles.levels = {0, 3};
    particles.arrays = {{"velocity", ElementType::float32, 3, std::vector<std::byte>(24)},
                        {"id", ElementType::uint32, 1, std::vector<std::byte>(8)}};
    for (const formats::ParticleFormat format : formats::written_particle_formats())
        formats::write_particles(directory / ("p." + std::string(name_of(format))), particles, format);
    formats::TriangleMesh mesh = formats::to_triangles(tetrahedron());
    mesh.attributes = {{"velocity", ElementType::float32, 3, std::vector<std::byte>(48)}};
    for (const char* name : {"m.ply", "m.vtk", "m.vtp", "m.npz"})
        formats::write_mesh(directory / name, mesh, formats::mesh_format_of(name));
    formats::write_mesh_vtp(directory / "z.vtp", mesh, {.compress = true});

    out.push_back({"xml ascii", vtu_ascii(), limited(formats::read_vtk_xml)});
    out.push_back({"xml inline", vtp_inline(), limited(formats::read_vtk_xml)});
    out.push_back({"xml raw", vtp_appended(), limited(formats::read_vtk_xml)});
    out.push_back({"xml of ours", bytes_of("p.vtp"), limited(formats::read_vtk_xml)});
    out.push_back({"npz particles", bytes_of("p.npz"), limited(formats::read_npz)});
    const std::string npz = bytes_of("p.npz");
    const std::size_t array = npz.find("\x93NUMPY");
    const auto read_npy = [](const std::string& bytes) { (void)formats::read_npy("sample", bytes); };
    out.push_back({"npy", npz.substr(array, npz.find("PK\3\4", array) - array), read_npy});
    const auto read_vtk = [](const std::string& bytes) { (void)formats::read_mesh_vtk("sample", bytes); };
    out.push_back({"mesh vtk", bytes_of("m.vtk"), read_vtk});
    out.push_back({"mesh vtp raw", vtp_appended(), limited(formats::read_mesh_vtp)});
    out.push_back({"mesh vtp", bytes_of("m.vtp"), limited(formats::read_mesh_vtp)});
    out.push_back({"mesh vtp zlib", bytes_of("z.vtp"), limited(formats::read_mesh_vtp)});
    out.push_back({"mesh npz", bytes_of("m.npz"), limited(formats::read_mesh_npz)});
}

/// The formats that are read alone.
void add_files_of_others(std::vector<Sample>& out) {
    const auto bgeo = [](const std::string& bytes) { (void)formats::read_bgeo("sample", bytes, small_limits); };
    out.push_back({"bgeo", sample_bgeo(), bgeo});
    out.push_back({"bgeo gzipped", gzipped(sample_bgeo()), bgeo});
    out.push_back({"json", "[[1, -2.5, 3e2],\n [0.1, 5, 6]]",
                   [](const std::string& bytes) { (void)formats::read_particle_json("sample", bytes); }});
    const auto bi4 = [](const std::string& bytes) { (void)formats::read_bi4("sample", bytes); };
    out.push_back({"bi4", Bi4{}.sample(), bi4});
    out.push_back({"bi4 wide", Bi4{std::endian::big, true}.sample(), bi4});
    out.push_back({"npz of PySPH", sample_pysph_npz(),
                   [](const std::string& bytes) { (void)formats::read_npz("sample", bytes, small_limits); }});
    out.push_back({"pickle", sample_pickle(), [](const std::string& bytes) {
                       const formats::ByteCursor at("sample", {});
                       formats::ReadBudget budget(small_limits, 0, at);
                       (void)formats::pysph_arrays(at, bytes, budget);
                   }});
}

}  // namespace

std::vector<Sample> samples() {
    std::vector<Sample> out;
    const auto particles = [](auto reader) {
        return [reader](const std::string& bytes) { (void)reader("sample", bytes, formats::ReadLimits{}); };
    };
    out.push_back({"vtk binary", vtk_binary(), particles(formats::read_vtk)});
    out.push_back({"vtk ascii", vtk_ascii(), particles(formats::read_vtk)});
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar level\nelement extra 1\nproperty list uchar int numbers\nend_header\n";
    for (const float x : {1.0F, 2.0F, 3.0F}) store(ply, x);
    ply += char{1};
    for (const float x : {4.0F, 5.0F, 6.0F}) store(ply, x);
    ply += char{2};
    ply += char{1};
    store(ply, std::int32_t{5});
    out.push_back({"particle ply binary", ply, particles(formats::read_particle_ply)});
    out.push_back(
        {"particle ply ascii",
         "ply\nformat ascii 1.0\ncomment c\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
         "end_header\n1 2 3\n4 5 6\n",
         particles(formats::read_particle_ply)});
    std::string xyz;
    for (int i = 0; i < 6; ++i) store(xyz, static_cast<float>(i));
    out.push_back({"xyz", xyz, particles(formats::read_xyz)});

    const TemporaryDirectory directory;
    formats::write_ply(directory / "mesh.ply", tetrahedron());
    formats::write_obj(directory / "mesh.obj", tetrahedron());
    out.push_back({"mesh ply", formats::read_file(directory / "mesh.ply"), particles(formats::read_mesh_ply)});
    out.push_back({"mesh obj", formats::read_file(directory / "mesh.obj"), particles(formats::read_obj)});
    add_written_files(out, directory);
    add_files_of_others(out);
    client::ReceivedFrame frame = client::encode_frame(tetrahedron(), {}, 4, 0.5);
    frame.bricks = {std::make_shared<const EncodedBrick>(
        EncodedBrick{{1, -2, 3}, 4, 4, {std::byte{1}}, std::vector<std::byte>(30, std::byte{9})})};
    frame.statistics.triangles = 4;
    formats::write_bricks(directory / "frame.bricks", frame);
    out.push_back({"bricks", formats::read_file(directory / "frame.bricks"),
                   [](const std::string& bytes) { (void)formats::read_bricks("sample", bytes); }});
    return out;
}

}  // namespace meniscus::test
