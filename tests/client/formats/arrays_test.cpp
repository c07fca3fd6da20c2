// The arrays of particles, from the files of every format and back to them.
#include <gtest/gtest.h>

#include "formats/bytes/atomic_file.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::test {
namespace {

using formats::NamedValues;
using formats::ParticleFormat;
using formats::Particles;

void expect_same(const std::vector<NamedValues>& read, const std::vector<NamedValues>& written) {
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].name, written[i].name);
        EXPECT_EQ(read[i].type, written[i].type) << read[i].name;
        EXPECT_EQ(read[i].components, written[i].components) << read[i].name;
        EXPECT_EQ(read[i].data, written[i].data) << read[i].name;
    }
}

/// The names, in their order.
std::string names_of(const Particles& particles) {
    std::string out;
    for (const NamedValues& array : particles.arrays) out += (out.empty() ? "" : " ") + array.name;
    return out;
}

/// An ASCII PLY with one vertex: x, y, z and these properties, "float vx 1".
Particles ply_with(const std::vector<std::array<std::string, 3>>& properties) {
    std::string header =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    std::string row = "0 0 0";
    for (const auto& [type, name, value] : properties) {
        header.append("property ").append(type).append(" ").append(name).append("\n");
        row += " " + value;
    }
    return formats::read_particle_ply("f", header + "end_header\n" + row + "\n");
}

std::string vtk_with(const std::string& point_data) {
    return "# vtk DataFile Version 4.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 1 1\nPOINT_DATA 2\n" +
           point_data;
}

TEST(ParticleArrays, OfEveryFormAreReadBackFromEveryFormatThatIsWritten) {
    const TemporaryDirectory directory;
    Particles particles;
    particles.positions = {0.1F, -2.5F, 3e7F, 4.0F, 5.0F, 6.0F};
    particles.levels = {1, 3};
    particles.arrays = {
        values_of<float>("age", ElementType::float32, 1, {0.5F, -1e-30F}),
        values_of<float>("velocity", ElementType::float32, 3, {1, 2, 3, 4, 5, 6}),
        values_of<float>("spin", ElementType::float32, 4, {1, 2, 3, 4, 5, 6, 7, 8}),
        values_of<std::uint8_t>("phase", ElementType::uint8, 1, {0, 255}),
        values_of<std::uint8_t>("color", ElementType::uint8, 4, {1, 2, 3, 4, 250, 251, 252, 253}),
        values_of<std::uint8_t>("paint", ElementType::uint8, 3, {1, 2, 3, 4, 5, 6}),
        values_of<std::int32_t>("shift", ElementType::int32, 1, {-7, 2147483647}),
        values_of<std::uint32_t>("id", ElementType::uint32, 1, {7, 4294967295U}),
    };
    for (const ParticleFormat format : formats::written_particle_formats()) {
        SCOPED_TRACE(name_of(format));
        const auto path = directory / ("p." + std::string(name_of(format)));
        formats::write_particles(path, particles, format);
        const Particles back = formats::read_particles(path);
        EXPECT_EQ(back.positions, particles.positions);
        EXPECT_EQ(back.levels, particles.levels);
        EXPECT_EQ(back.faces, 0U);
        EXPECT_EQ(back.left_out, std::vector<std::string>{});
        expect_same(back.arrays, particles.arrays);
    }
}

TEST(ParticleArrays, AreWrittenOfNoParticles) {
    const TemporaryDirectory directory;
    Particles none;
    none.arrays = {values_of<float>("age", ElementType::float32, 1, {})};
    for (const ParticleFormat format : formats::written_particle_formats()) {
        const auto path = directory / ("p." + std::string(name_of(format)));
        formats::write_particles(path, none, format);
        EXPECT_EQ(formats::read_particles(path).count(), 0U) << name_of(format);
    }
}

TEST(ParticleArrays, AreNotWrittenInOtherFormats) {
    EXPECT_EQ(refusal([] { formats::write_particles("p.xyz", Particles(), ParticleFormat::xyz); }),
              "p.xyz: particles are written as ply, vtk, vtp or npz, not as xyz");
}

TEST(PlyArrays, ComponentsInPropertiesOfTheirOwnAreOneArray) {
    const Particles particles = ply_with({{"float", "pressure", "7"},
                                          {"double", "vx", "1"},
                                          {"double", "vy", "2"},
                                          {"double", "vz", "3"},
                                          {"uchar", "red", "10"},
                                          {"uchar", "green", "20"},
                                          {"uchar", "blue", "30"},
                                          {"float", "spin_x", "4"},
                                          {"float", "spin_y", "5"},
                                          {"float", "spin_z", "6"},
                                          {"float", "spin_w", "7"}});
    EXPECT_EQ(names_of(particles), "pressure velocity color spin");
    EXPECT_EQ(numbers_of<float>(particles.arrays[1]), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(numbers_of<std::uint8_t>(particles.arrays[2]), (std::vector<std::uint8_t>{10, 20, 30}));
    EXPECT_EQ(numbers_of<float>(particles.arrays[3]), (std::vector<float>{4, 5, 6, 7}));
}

TEST(PlyArrays, AlphaIsTheFourthComponentOfAColor) {
    const Particles particles =
        ply_with({{"uchar", "alpha", "40"}, {"uchar", "red", "10"}, {"uchar", "green", "20"}, {"uchar", "blue", "30"}});
    EXPECT_EQ(names_of(particles), "color");
    EXPECT_EQ(numbers_of<std::uint8_t>(particles.arrays[0]), (std::vector<std::uint8_t>{10, 20, 30, 40}));
}

TEST(PlyArrays, ComponentsOfDifferentTypesOrWithAGapStayScalars) {
    EXPECT_EQ(names_of(ply_with({{"float", "vx", "1"}, {"float", "vy", "2"}})), "vx vy");
    EXPECT_EQ(names_of(ply_with({{"float", "vx", "1"}, {"float", "vy", "2"}, {"int", "vz", "3"}})), "vx vy vz");
    EXPECT_EQ(names_of(ply_with(
                  {{"float", "velocity", "0"}, {"float", "vx", "1"}, {"float", "vy", "2"}, {"float", "vz", "3"}})),
              "velocity vx vy vz");
}

TEST(PlyArrays, IntegersAreIds) {
    const Particles particles =
        ply_with({{"short", "a", "-3"}, {"ushort", "b", "3"}, {"uint", "c", "4294967295"}, {"uchar", "d", "9"}});
    ASSERT_EQ(particles.arrays.size(), 4U);
    EXPECT_EQ(particles.arrays[0].type, ElementType::int32);
    EXPECT_EQ(numbers_of<std::int32_t>(particles.arrays[0])[0], -3);
    EXPECT_EQ(particles.arrays[1].type, ElementType::uint32);
    EXPECT_EQ(numbers_of<std::uint32_t>(particles.arrays[2])[0], 4294967295U);
    EXPECT_EQ(particles.arrays[3].type, ElementType::uint8);
}

TEST(PlyArrays, WhatCannotBeAnAttributeIsLeftOutWithAReason) {
    const Particles particles = ply_with(
        {{"double", "far", "1e300"}, {"uchar", "Age", "2"}, {"float", "age", "3"}, {"float", "position", "3"}});
    EXPECT_EQ(names_of(particles), "age");
    EXPECT_EQ(particles.left_out,
              (std::vector<std::string>{"far (a value is beyond float32)", "age (the name of another array)",
                                        "position (a name with another meaning)"}));
}

TEST(PlyArrays, TheFirstSixteenAreKept) {
    std::vector<std::array<std::string, 3>> properties;
    properties.reserve(18);
    for (int i = 0; i < 18; ++i) properties.push_back({"float", "a" + std::to_string(i), "0"});
    const Particles particles = ply_with(properties);
    EXPECT_EQ(particles.arrays.size(), max_particle_arrays);
    EXPECT_EQ(particles.arrays.back().name, "a15");
    EXPECT_EQ(particles.left_out, (std::vector<std::string>{"a16 (after the first 16)", "a17 (after the first 16)"}));
}

TEST(VtkArrays, OfPointsAreReadInAsciiAndBinary) {
    const Particles binary = formats::read_vtk("f", vtk_binary());
    EXPECT_EQ(names_of(binary), "id velocity pressure");
    EXPECT_EQ(numbers_of<std::uint32_t>(binary.arrays[0]), (std::vector<std::uint32_t>{7, 8}));
    EXPECT_EQ(numbers_of<float>(binary.arrays[2]), (std::vector<float>{1.5F, 2.5F}));
    const Particles ascii = formats::read_vtk("f", vtk_ascii());
    EXPECT_EQ(names_of(ascii), "velocity");
    EXPECT_EQ(numbers_of<float>(ascii.arrays[0]), (std::vector<float>{0, 0, 0, 1, 1, 1}));
}

TEST(VtkArrays, OfCellsAreNotThoseOfPoints) {
    std::string text = vtk_ascii();
    text.replace(text.find("POINT_DATA"), 10, "CELL_DATA");
    EXPECT_EQ(formats::read_vtk("f", text).arrays.size(), 0U);
}

TEST(VtkArrays, LongIntegersAreIdsWhereTheyFit) {
    const auto read = [](const std::string& a, const std::string& b) {
        return formats::read_vtk("f", vtk_with("SCALARS id long 1\nLOOKUP_TABLE default\n" + a + " " + b + "\n"));
    };
    EXPECT_EQ(read("-1", "2147483647").arrays[0].type, ElementType::int32);
    EXPECT_EQ(read("0", "4294967295").arrays[0].type, ElementType::uint32);
    EXPECT_EQ(read("0", "4294967296").left_out, (std::vector<std::string>{"id (a value that int32 does not hold)"}));
    EXPECT_EQ(read("-1", "4294967295").left_out, (std::vector<std::string>{"id (values that int32 does not hold)"}));
}

TEST(VtkArrays, ColorsAreBytes) {
    const Particles particles = formats::read_vtk("f", vtk_with("COLOR_SCALARS paint 3\n0 0.5 1 1 0 0.2\n"));
    EXPECT_EQ(names_of(particles), "paint");
    EXPECT_EQ(numbers_of<std::uint8_t>(particles.arrays[0]), (std::vector<std::uint8_t>{0, 128, 255, 255, 0, 51}));
}

TEST(VtkArrays, TensorsAreLeftOut) {
    const Particles particles = formats::read_vtk(
        "f", vtk_with("TENSORS stress float\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 9\nSCALARS a float\n1 2\n"));
    EXPECT_EQ(names_of(particles), "a");
    EXPECT_EQ(particles.left_out, (std::vector<std::string>{"stress (9 components of float32)"}));
}

TEST(VtkArrays, OfAnotherLengthThanThePointsAreRefusedByName) {
    EXPECT_EQ(refusal([] { formats::read_vtk("f", vtk_with("FIELD d 1\nage 1 3 float\n1 2 3\n")); }),
              "f: point data 'age' has 3 values for 2 points");
}

TEST(ArrayNames, OfOtherCharactersAreMadeToFit) {
    EXPECT_EQ(formats::array_name("Velocity (m/s)"), "velocity__m_s_");
    EXPECT_EQ(formats::array_name(""), "_");
    EXPECT_EQ(formats::array_name(std::string(100, 'A')), std::string(64, 'a'));
}

TEST(ArrayNames, ThatAFileLacksAreRefusedWithThoseThatItHas) {
    const Particles particles =
        formats::read_vtk("f", vtk_with("TENSORS stress float\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 9\nVECTORS v "
                                        "float\n1 2 3 4 5 6\nSCALARS id int\n1 2\n"));
    const std::vector<std::string> there{"v", "id"}, missing{"v", "speed"};
    EXPECT_EQ(refusal([&] { formats::require_arrays("f", particles, there); }), "");
    EXPECT_EQ(
        refusal([&] { formats::require_arrays("f", particles, missing); }),
        "f: no array 'speed'; the file has v (3 float32), id (int32); left out: stress (9 components of float32)");
    EXPECT_EQ(refusal([&] { formats::require_arrays("f", Particles(), missing); }),
              "f: no array 'v'; the file has no arrays");
}

TEST(ReadLimits, AFileLargerThanTheLimitIsNotRead) {
    const TemporaryDirectory directory;
    formats::write_file(directory / "p.xyz", std::string(24, '\0'));
    EXPECT_EQ(formats::read_particles(directory / "p.xyz", std::nullopt, {.most_bytes = 24}).count(), 2U);
    EXPECT_NE(refusal([&] {
                  formats::read_particles(directory / "p.xyz", std::nullopt, {.most_bytes = 23});
              }).find("p.xyz: has 24 bytes; at most 23 are read"),
              std::string::npos);
}

TEST(VtkArrays, OfRealFramesAreIdsAndVelocities) {
    const auto folder = data_folder();
    if (!folder) GTEST_SKIP() << "MENISCUS_DATA is not set";
    const Particles frame = formats::read_particles(*folder / "double_dam_break_with_sphere/frame_040.vtk");
    EXPECT_EQ(names_of(frame), "id velocity");
    EXPECT_EQ(frame.arrays[1].count(), 11492U);
}

}  // namespace
}  // namespace meniscus::test
