#include "hostile/bombs.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>

#include "formats/bgeo_sample.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/containers/npy.hpp"
#include "formats/pysph_sample.hpp"
#include "hostile/crafted_zip.hpp"
#include "hostile/deflating.hpp"

namespace meniscus::test {
namespace {

using formats::store;

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20U;

std::string repeated(const std::string& text, std::size_t count) {
    std::string out;
    out.reserve(text.size() * count);
    for (std::size_t i = 0; i < count; ++i) out += text;
    return out;
}

std::string long_get(std::uint32_t place) {
    std::string out = "j";
    store(out, place);
    return out;
}
std::string long_put(std::uint32_t place) {
    std::string out = "r";
    store(out, place);
    return out;
}

/// PySPH's particles, pickled: `before` the dictionary, whose arrays are x, y, z and `more`.
std::string particles_pickle(const std::string& before, const std::string& more) {
    std::string arrays = "}(";
    for (const char* axis : {"x", "y", "z"})
        arrays += short_text(axis) + numpy_array("f8", 1, pickled_bytes<double>({1.0}));
    const std::string kinds =
        "}" + short_text("fluid") + "}" + short_text("arrays") + std::move(arrays) + more + "u" + "ss";
    return "\x80\x03" + before + "cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n" + small(0) + "\x85" +
           std::string("C\x01") + "b" + "\x87R(" + small(1) + ")" + "cnumpy\ndtype\n" + short_text("O8") +
           "\x89\x88\x87R(" + small(3) + short_text("|") + "tb" + "\x89]" + kinds + "atb.";
}

std::string particles_npz(const std::string& pickle) {
    Deflating content(Deflating::raw);
    content.add(formats::npy_header("|O", {}));
    content.add(pickle);
    return crafted_zip("particles.npy", content);
}

/// Arrays that have one shape of 900,000 sizes.
std::string shared_shape(std::size_t arrays) {
    constexpr std::uint32_t shape = 1000;
    const std::string before =
        small(1) + long_put(999) + "0(" + repeated(long_get(999), 900'000) + "t" + long_put(shape) + "0";
    std::string array = numpy_array("f8", 1, pickled_bytes<double>({1.0}));
    const std::string own_shape = small(1) + "\x85";
    array.replace(array.find(small(1) + own_shape) + 2, own_shape.size(), long_get(shape));
    std::string more = short_text("a") + array + long_put(1001);
    for (std::size_t i = 1; i < arrays; ++i) more += short_text("a") + long_get(1001);
    return particles_npz(particles_pickle(before, more));
}

/// One array under two million names.
std::string shared_array() {
    std::string more =
        short_text("a") + long_put(1000) + numpy_array("f8", 1, pickled_bytes<double>({1.0})) + long_put(1001);
    return particles_npz(particles_pickle("", more + repeated(long_get(1000) + long_get(1001), 1'900'000)));
}

/// Arrays whose type has a name of 16 MiB.
std::string long_type() {
    std::string name = "X";
    store(name, static_cast<std::uint32_t>(16 * mebibyte));
    name.append(16 * mebibyte, 'f');
    const std::string before = name + long_put(1000) + "0";
    std::string array = numpy_array("f8", 1, pickled_bytes<double>({1.0}));
    array.replace(array.find(short_text("f8")), short_text("f8").size(), long_get(1000));
    std::string more = short_text("a") + array + long_put(1001);
    for (int i = 0; i < 4000; ++i) more += short_text("a") + long_get(1001);
    return particles_npz(particles_pickle(before, more));
}

/// A pickle of one operation that keeps a value in a table of all that it may use again.
std::string memo() {
    Deflating content(Deflating::raw);
    content.add(formats::npy_header("|O", {}));
    content.add("\x80\x04N");
    content.repeat(std::string(1 << 16, '\x94'), 60 * mebibyte);
    content.add(".");
    return crafted_zip("particles.npy", content);
}

/// Members of 60 MiB that are one stream.
std::string one_stream(std::size_t members) {
    Deflating content(Deflating::raw);
    const std::uint64_t count = 5 * mebibyte;
    content.add(formats::npy_header("<f4", {count, 3}));
    content.zeros(12 * count);
    const std::string stored = content.finish();
    std::vector<CraftedMember> directory;
    for (std::size_t i = 0; i < members; ++i)
        directory.push_back({(i == 0 ? "positions" : "a" + std::to_string(i)) + ".npy",
                             static_cast<std::uint32_t>(content.size()), static_cast<std::uint32_t>(stored.size()),
                             content.crc(), 0});
    return crafted_zip(crafted_local(stored), directory);
}

/// Members of 30 MiB, each with bytes of its own, of which none is of the particles.
std::string announced_in_sum() {
    Deflating content(Deflating::raw);
    content.add(formats::npy_header("<f4", {30 * mebibyte / 4}));
    content.zeros(30 * mebibyte);
    const std::string local = crafted_local(content.finish());
    std::string locals;
    std::vector<CraftedMember> directory;
    for (std::uint32_t i = 0; i < 400; ++i) {
        directory.push_back({"a" + std::to_string(i) + ".npy", static_cast<std::uint32_t>(content.size()),
                             static_cast<std::uint32_t>(local.size() - 30), content.crc(),
                             static_cast<std::uint32_t>(locals.size())});
        locals += local;
    }
    return crafted_zip(locals, directory);
}

/// A particle, an array of 30 MiB, and small ones of its name.
std::string equal_names() {
    std::string locals;
    std::vector<CraftedMember> directory;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        const std::uint64_t count = i == 1 ? 30 * mebibyte / 12 : 1;
        Deflating content(Deflating::raw);
        content.add(formats::npy_header("<f4", {count, 3}));
        content.zeros(12 * count);
        const std::string local = crafted_local(content.finish());
        directory.push_back({i == 0 ? "positions.npy" : "a.npy", static_cast<std::uint32_t>(content.size()),
                             static_cast<std::uint32_t>(local.size() - 30), content.crc(),
                             static_cast<std::uint32_t>(locals.size())});
        locals += local;
    }
    return crafted_zip(locals, directory);
}

std::string vtk_xml(const std::string& kind, const std::string& pieces, const std::string& more = {},
                    const std::string& attributes = {}) {
    return "<VTKFile type=\"" + kind + "\" byte_order=\"LittleEndian\"" + attributes + "><" + kind + ">" + pieces +
           "</" + kind + ">" + more + "</VTKFile>";
}
const std::string one_point = "<Points><DataArray type='Float32' NumberOfComponents='3'>0 0 0</DataArray></Points>";

std::string arrays_of_one_point(std::size_t count) {
    std::string arrays;
    for (std::size_t i = 0; i < count; ++i)
        arrays += "<DataArray type='Float32' Name='a" + std::to_string(i) + "'>0</DataArray>";
    return vtk_xml("PolyData",
                   "<Piece NumberOfPoints='1'>" + one_point + "<PointData>" + arrays + "</PointData></Piece>");
}

/// Elements before the one that is looked for again and again.
std::string crowded_piece() {
    std::string arrays;
    for (int i = 0; i < 4000; ++i)
        arrays += "<DataArray type='Float32' Name='a" + std::to_string(i) + "'>0</DataArray>";
    return vtk_xml("PolyData", "<Piece NumberOfPoints='1'>" + repeated("<a/>", 400'000) + one_point + "<PointData>" +
                                   arrays + "</PointData></Piece>");
}

std::string many_pieces() {
    std::string arrays;
    for (int i = 0; i < 4000; ++i)
        arrays += "<DataArray type='Float32' Name='a" + std::to_string(i) + "'>0</DataArray>";
    return vtk_xml("PolyData", "<Piece NumberOfPoints='1'>" + one_point + "<PointData>" + arrays +
                                   "</PointData></Piece>" + repeated("<Piece NumberOfPoints='0'/>", 200'000));
}

std::string equal_arrays() {
    return vtk_xml("PolyData", "<Piece NumberOfPoints='1'>" + one_point + "<PointData><DataArray type='Float32' " +
                                   repeated("a='' ", 400'000) + "Name='a'>0</DataArray>" +
                                   repeated("<DataArray type='Float32' Name='a'>0</DataArray>", 4000) +
                                   "</PointData></Piece>");
}

/// Pieces whose cells are one array of a million types.
std::string shared_cells() {
    const std::string piece = "<Piece NumberOfPoints='1' NumberOfCells='1000000'>" + one_point +
                              "<Cells><DataArray type='UInt8' Name='types' format='appended' offset='0'/></Cells>"
                              "</Piece>";
    std::string data;
    store(data, std::uint32_t{1'000'000});
    data.append(1'000'000, '\1');
    return vtk_xml("UnstructuredGrid", repeated(piece, 20'000),
                   "<AppendedData encoding=\"raw\">_" + data + "</AppendedData>");
}

/// An array in a million compressed blocks of one byte.
std::string small_blocks() {
    Deflating one(15);
    one.add(std::string(1, '\0'));
    const std::string block = one.finish();
    constexpr std::uint32_t blocks = 1'200'000;
    std::string data;
    for (const std::uint32_t number : {blocks, 1U, 0U}) store(data, number);
    for (std::uint32_t i = 0; i < blocks; ++i) store(data, static_cast<std::uint32_t>(block.size()));
    data += repeated(block, blocks);
    return vtk_xml("PolyData",
                   "<Piece NumberOfPoints='" + std::to_string(blocks / 12) +
                       "'><Points><DataArray type='Float32' NumberOfComponents='3' format='appended' offset='0'/>"
                       "</Points></Piece>",
                   "<AppendedData encoding=\"raw\">_" + data + "</AppendedData>",
                   " compressor=\"vtkZLibDataCompressor\"");
}

std::string gzipped_bgeo(const std::string& beginning, std::uint64_t zeros) {
    Deflating content(Deflating::gzip);
    content.add(beginning);
    content.zeros(zeros);
    return content.finish();
}
std::string string_attribute(std::int32_t strings) {
    return counted("a") + std::string{0, 1} + big(std::int32_t{4}) + big(strings);
}

/// Two thousand million strings without a byte.
std::string empty_strings() {
    return gzipped_bgeo(bgeo_header(1, 1) + string_attribute(0x7fffffff), 128 * mebibyte);
}
/// As many as one attribute may have, in each of many.
std::string empty_strings_of_attributes() {
    Deflating content(Deflating::gzip);
    content.add(bgeo_header(1, 4096));
    for (int i = 0; i < 40; ++i) {
        content.add(string_attribute(1'000'000));
        content.zeros(2'000'000);
    }
    return content.finish();
}
std::string zero_points() {
    return gzipped_bgeo(bgeo_header(100'000'000, 0), 1600 * mebibyte / 16);
}

std::string ply_properties() {
    std::string out = "ply\nformat ascii 1.0\nelement vertex 1\n";
    for (const char* axis : {"x", "y", "z"}) out += "property float " + std::string(axis) + "\n";
    return out + repeated("property char a\n", 3'000'000) + "end_header\n";
}
std::string ply_of_one_face() {
    std::string out =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\nproperty char z\n"
        "element face 1\nproperty list uint uchar vertex_indices\nend_header\n";
    out.append(3, '\0');
    constexpr std::uint32_t corners = 40'000'000;
    store(out, corners);
    return out + std::string(corners, '\0');
}
std::string obj_of_one_face() {
    return "v 0 0 0\nf" + repeated(" 1", 20'000'000) + "\n";
}
std::string legacy_polygon() {
    return "# vtk DataFile Version 4.1\na\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 15000001\n"
           "15000000" +
           repeated(" 0", 15'000'000) + "\n";
}
std::string legacy_points() {
    return "# vtk DataFile Version 4.1\na\nASCII\nDATASET POLYDATA\nPOINTS 10000000 float\n" +
           repeated("0 0 0 ", 10'000'000);
}
std::string legacy_arrays() {
    return "# vtk DataFile Version 4.1\na\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nFIELD f "
           "2000000\n" +
           repeated("a 1 1 float 0\n", 2'000'000);
}
std::string json_zeros() {
    return "[[0,0,0]" + repeated(",[0,0,0]", 5'000'000) + "]";
}

}  // namespace

void write(const Bomb& bomb, const std::filesystem::path& path) {
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            formats::write_file(path, bomb.bytes());
        } catch (const std::exception&) {
            ::_exit(1);
        }
        ::_exit(0);
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0)
        throw std::runtime_error(bomb.name + " cannot be written");
}

std::vector<Bomb> bombs() {
    return {
        {"a shape of 900,000 sizes that 400 arrays share", ".npz", false, [] { return shared_shape(400); }},
        {"a shape of 900,000 sizes that 90,000 arrays share", ".npz", false, [] { return shared_shape(90'000); }},
        {"one array under two million names", ".npz", false, shared_array},
        {"a name of a type of 16 MiB that 4,000 arrays share", ".npz", false, long_type},
        {"a pickle that keeps 60 million values", ".npz", false, memo},
        {"100 members that are one stream", ".npz", true, [] { return one_stream(100); }},
        {"4,096 members that are one stream", ".npz", true, [] { return one_stream(4096); }},
        {"4,000 members of one name", ".npz", true, equal_names},
        {"400 members of 30 MiB each", ".npz", true, announced_in_sum},
        {"40,000 arrays of one point", ".vtp", true, [] { return arrays_of_one_point(40'000); }},
        {"4,000 arrays behind 400,000 elements", ".vtp", true, crowded_piece},
        {"4,000 arrays, 200,000 empty pieces", ".vtp", true, many_pieces},
        {"4,000 arrays of one name, the first with 400,000 attributes", ".vtp", true, equal_arrays},
        {"20,000 pieces that share their cells", ".vtu", false, shared_cells},
        {"a million compressed blocks of a byte", ".vtp", true, small_blocks},
        {"two thousand million strings without a byte", ".bgeo.gz", false, empty_strings},
        {"a million strings without a byte in each attribute", ".bgeo.gz", false, empty_strings_of_attributes},
        {"a hundred million points of zeros", ".bgeo.gz", false, zero_points},
        {"three million properties", ".ply", true, ply_properties},
        {"a face of 40 million corners", ".ply", true, ply_of_one_face},
        {"a face of 20 million corners", ".obj", true, obj_of_one_face},
        {"a polygon of 15 million corners", ".vtk", true, legacy_polygon},
        {"ten million points of six bytes each", ".vtk", true, legacy_points},
        {"two million arrays of one point", ".vtk", true, legacy_arrays},
        {"five million points as text", ".json", false, json_zeros},
    };
}

}  // namespace meniscus::test
