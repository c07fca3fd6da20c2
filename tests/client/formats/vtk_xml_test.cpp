// VTK's XML: the forms that arrays come in, and what is said of those that are wrong.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <span>

#include "formats/bytes/scalar.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

using formats::Particles;
using formats::store;

const std::vector<float> xml_points{1, 2, 3, 4, 5, 6};
const std::vector<float> xml_ages{0.5F, 1.5F};

std::string base64(std::string_view bytes) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j)
            bits = bits << 8U | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
        for (std::size_t j = 0; j < 4; ++j) out += j <= bytes.size() - i ? digits[bits >> (18 - 6 * j) & 63U] : '=';
    }
    return out;
}

/// How a file of two points is written.
struct Form {
    std::string format = "binary";  ///< inline; or "appended", and "ascii"
    bool base64_appended = false;
    bool compressed = false;
    std::size_t block_bytes = 8;
    bool wide_header = false;
    std::endian order = std::endian::little;

    std::string name() const {
        return format + (base64_appended ? ", base64" : "") + (compressed ? ", compressed" : "") +
               (wide_header ? ", UInt64" : "") + (order == std::endian::big ? ", big-endian" : "");
    }
};

void store_word(std::string& out, std::uint64_t value, const Form& form) {
    if (form.wide_header)
        store(out, value, form.order);
    else
        store(out, static_cast<std::uint32_t>(value), form.order);
}

/// The header and the bytes of an array, in base64 where `text`.
std::string packed(const std::string& bytes, const Form& form, bool text) {
    std::string header, body;
    if (form.compressed) {
        std::vector<std::string> blocks;
        for (std::size_t at = 0; at < bytes.size(); at += form.block_bytes) {
            const std::string block = bytes.substr(at, form.block_bytes);
            uLongf size = ::compressBound(block.size());
            std::string out(size, '\0');
            ::compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(block.data()),
                       block.size());
            blocks.push_back(out.substr(0, size));
        }
        store_word(header, blocks.size(), form);
        store_word(header, form.block_bytes, form);
        store_word(header, bytes.size() % form.block_bytes, form);
        for (const std::string& block : blocks) {
            store_word(header, block.size(), form);
            body += block;
        }
        return text ? base64(header) + base64(body) : header + body;  // two streams, as VTK writes them
    }
    store_word(header, bytes.size(), form);
    return text ? base64(header + bytes) : header + bytes;
}

class File {
public:
    explicit File(Form form) : form_(std::move(form)) {}

    std::string array(const std::string& name, const std::vector<float>& numbers, int components) {
        std::string text, bytes;
        for (const float x : numbers) {
            text += std::to_string(x) + " ";
            store(bytes, x, form_.order);
        }
        std::string tag = "<DataArray type=\"Float32\" Name=\"" + name + "\" NumberOfComponents=\"" +
                          std::to_string(components) + "\" format=\"" + form_.format + "\"";
        if (form_.format != "appended")
            return tag + ">\n  " + (form_.format == "ascii" ? text : packed(bytes, form_, true)) + "\n</DataArray>\n";
        tag += " offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
        appended_ += packed(bytes, form_, form_.base64_appended);
        return tag;
    }

    /// Pieces of two points with an array.
    std::string text(int pieces = 1) {
        std::string body;
        for (int i = 0; i < pieces; ++i) {
            // One after the other, as they are appended.
            const std::string points = array("Points", xml_points, 3);
            const std::string ages = array("Age", xml_ages, 1);
            body.append("<Piece NumberOfPoints=\"2\" NumberOfVerts=\"0\"><Points>")
                .append(points)
                .append("</Points><PointData>")
                .append(ages)
                .append("</PointData></Piece>\n");
        }
        std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
        out += form_.order == std::endian::big ? "BigEndian\"" : "LittleEndian\"";
        if (form_.wide_header) out += " header_type=\"UInt64\"";
        if (form_.compressed) out += " compressor=\"vtkZLibDataCompressor\"";
        out += "><PolyData>" + body + "</PolyData>\n";
        if (form_.format == "appended")
            out += std::string("<AppendedData encoding=\"") + (form_.base64_appended ? "base64" : "raw") + "\">\n _" +
                   appended_ + "\n</AppendedData>\n";
        return out + "</VTKFile>\n";
    }

private:
    Form form_;
    std::string appended_;
};

Particles read(const std::string& bytes, const formats::ReadLimits& limits = {}) {
    return formats::read_vtk_xml("f", bytes, limits);
}

std::vector<Form> all_forms() {
    std::vector<Form> out{{.format = "ascii"}};
    for (const bool compressed : {false, true})
        for (const bool wide : {false, true})
            for (const std::endian order : {std::endian::little, std::endian::big})
                for (const int kind : {0, 1, 2})
                    out.push_back({.format = kind == 0 ? "binary" : "appended",
                                   .base64_appended = kind == 2,
                                   .compressed = compressed,
                                   .wide_header = wide,
                                   .order = order});
    return out;
}

TEST(VtkXml, IsReadInEveryForm) {
    for (const Form& form : all_forms()) {
        SCOPED_TRACE(form.name());
        const Particles particles = read(File(form).text());
        EXPECT_EQ(particles.positions, xml_points);
        ASSERT_EQ(particles.arrays.size(), 1U);
        EXPECT_EQ(particles.arrays[0].name, "age");
        ASSERT_EQ(particles.arrays[0].data.size(), 8U);
        const auto ages = std::as_bytes(std::span(xml_ages));
        EXPECT_TRUE(std::ranges::equal(particles.arrays[0].data, ages));
    }
}

TEST(VtkXml, PiecesAreReadOneBehindTheOther) {
    for (const Form& form : {Form{.format = "ascii"}, Form{.format = "appended", .compressed = true}}) {
        const Particles particles = read(File(form).text(3));
        ASSERT_EQ(particles.count(), 6U);
        EXPECT_EQ(particles.positions[15], 4.0F);
        EXPECT_EQ(particles.arrays.at(0).count(), 6U);
    }
}

TEST(VtkXml, APieceThatLacksAnArrayOfTheOthersIsRefused) {
    std::string text = File(Form{.format = "ascii"}).text(2);
    text.replace(text.rfind("\"Age\""), 5, "\"Old\"");
    EXPECT_EQ(refusal([&] { read(text); }), "f: piece 2 has no array 'Age' like that of the pieces before");
}

TEST(VtkXml, ABombStopsAtTheSizeThatTheFileMayHave) {
    // A megabyte of zeros in a kilobyte.
    const Form form{.format = "appended", .compressed = true, .block_bytes = 1 << 20};
    std::string text = File(form).text();
    const std::string zeros(1200000, '\0');
    const std::string data = packed(zeros, form, false);
    text.replace(text.find("NumberOfPoints=\"2\""), 18, "NumberOfPoints=\"100000\"");
    const std::size_t begin = text.find('_', text.find("<AppendedData")) + 1;
    text.replace(begin, text.find("\n</AppendedData>") - begin, data);
    text.replace(text.find("<PointData>"), text.find("</PointData>") - text.find("<PointData>"), "<PointData>");
    EXPECT_EQ(read(text).count(), 100000U);
    const std::string message = refusal([&] { read(text, {.most_bytes = 1000000}); });
    EXPECT_NE(message.find("1200000 bytes for "), std::string::npos) << message;
    EXPECT_NE(message.find("of the 1000000 that a file may take"), std::string::npos) << message;
}

TEST(VtkXml, ABlockThatIsLargerThanItSaysIsRefused) {
    const Form form{.format = "appended", .compressed = true};
    std::string text = File(form).text();
    Form lying = form;
    lying.block_bytes = 12;
    // The header says blocks of 8 bytes; the first has 12.
    std::string bytes;
    for (const float x : xml_points) store(bytes, x);
    std::string data = packed(bytes, lying, false);
    std::string header;
    for (const std::uint32_t word : {3U, 8U, 0U}) store(header, word);
    data = header + data.substr(12, 8) + std::string(4, '\1') + data.substr(20);
    text.replace(text.find('_', text.find("<AppendedData")) + 1, data.size(), data);
    const std::string message = refusal([&] { read(text); });
    EXPECT_NE(message.find("piece 1, Points has more than the 8 bytes"), std::string::npos) << message;
}

TEST(VtkXml, WhatIsWrongIsNamedWithItsPlace) {
    const auto said = [](const std::string& from, const std::string& to, const Form& form = {.format = "ascii"}) {
        std::string text = File(form).text();
        text.replace(text.find(from), from.size(), to);
        std::string message = refusal([&] { read(text); });
        EXPECT_EQ(message.find('\n'), std::string::npos);
        return message;
    };
    EXPECT_EQ(said("type=\"PolyData\"", "type=\"ImageData\""),
              "f: VTKFile of type 'ImageData' holds no particles and no faces; UnstructuredGrid and PolyData are read");
    EXPECT_EQ(said("NumberOfPoints=\"2\"", "NumberOfPoints=\"two\""),
              "f: piece 1, NumberOfPoints: 'two' is not a count");
    EXPECT_NE(said("NumberOfPoints=\"2\"", "NumberOfPoints=\"3\"").find("f: piece 1, Points: "), std::string::npos);
    EXPECT_NE(said("0.500000", "half").find("piece 1, array 'Age': value: 'half' is not a number"), std::string::npos);
    EXPECT_NE(said("</Points>", "</Pints>").find("f: no XML at byte "), std::string::npos);
    EXPECT_NE(said("format=\"binary\"", "format=\"octal\"", {}).find("ascii, binary and appended are read"),
              std::string::npos);
    EXPECT_NE(
        said("vtkZLibDataCompressor", "vtkLZ4DataCompressor", {.compressed = true}).find("'vtkLZ4DataCompressor'"),
        std::string::npos);
    EXPECT_NE(said("offset=\"0\"", "offset=\"9999\"", {.format = "appended"}).find("begins at byte 9999 of"),
              std::string::npos);
    EXPECT_EQ(refusal([] { read("<html></html>"); }), "f: not a VTK XML file: it has no element VTKFile");
    EXPECT_NE(refusal([] { read(""); }), "");
}

TEST(VtkXml, MoreElementsThanMemoryIsMeantForAreRefused) {
    std::string text = "<VTKFile>";
    for (int i = 0; i < 1000001; ++i) text += "<a/>";
    EXPECT_EQ(refusal([&] { read(text); }), "f: more than 1000000 elements and attributes");
}

TEST(VtkXml, RealFilesHaveTheirPointsAndArrays) {
    const auto folder = data_folder();
    if (!folder) GTEST_SKIP() << "MENISCUS_DATA is not set";
    const Particles fluid = formats::read_particles(*folder / "single_frames/fluid_250_particles.vtu");
    EXPECT_EQ(fluid.count(), 250U);
    std::string names;
    for (const auto& array : fluid.arrays) names += array.name + std::to_string(array.components) + " ";
    EXPECT_EQ(names, "velocity3 pressure1 density1 index1 ");
    EXPECT_EQ(fluid.arrays[3].type, ElementType::int32);
    // Two files have the same eight particles: one is XML, one is legacy VTK.
    const Particles cube = formats::read_particles(*folder / "single_frames/cube_8_particles.vtu");
    const Particles legacy = formats::read_particles(*folder / "single_frames/cube_8_particles.vtk");
    EXPECT_EQ(cube.positions, legacy.positions);
}

}  // namespace
}  // namespace meniscus::test
