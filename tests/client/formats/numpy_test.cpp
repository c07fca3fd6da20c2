// numpy's files: forms that arrays come in, zip files that lie.
#include <gtest/gtest.h>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/npy.hpp"
#include "formats/containers/npz_writer.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/particles/particles.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::test {
namespace {

using formats::Particles;
using formats::store;

const std::vector<float> numpy_points{1, 2, 3, 4, 5, 6};

template <class T>
std::string npy(const std::string& descr, const std::vector<T>& numbers, const std::vector<std::size_t>& shape,
                bool fortran = false) {
    std::string out = formats::npy_header(descr, shape);
    if (fortran) out.replace(out.find("False"), 5, "True ");
    for (const T x : numbers) store(out, x, descr[0] == '>' ? std::endian::big : std::endian::little);
    return out;
}

std::string bytes_of(const std::vector<float>& numbers) {
    std::string out;
    for (const float x : numbers) store(out, x);
    return out;
}

/// The bytes of an .npz with these arrays.
template <class Add>
std::string npz(const Add& add) {
    const TemporaryDirectory directory;
    formats::NpzWriter out(directory / "a.npz");
    add(out);
    out.commit();
    return formats::read_file(directory / "a.npz");
}

std::string said_of_npy(const std::string& bytes) {
    return refusal([&] { formats::read_npy("f", bytes); });
}

std::string said_of_npz(const std::string& bytes) {
    return refusal([&] { formats::read_npz("f", bytes, {}); });
}

TEST(Npy, PositionsAreReadInBothOrdersAndWidths) {
    EXPECT_EQ(formats::read_npy("f", npy<float>("<f4", {1, 2, 3, 4, 5, 6}, {2, 3})).positions, numpy_points);
    EXPECT_EQ(formats::read_npy("f", npy<float>(">f4", {1, 2, 3, 4, 5, 6}, {2, 3})).positions, numpy_points);
    EXPECT_EQ(formats::read_npy("f", npy<double>("<f8", {1, 2, 3, 4, 5, 6}, {2, 3})).positions, numpy_points);
    EXPECT_EQ(formats::read_npy("f", npy<double>(">f8", {1, 4, 2, 5, 3, 6}, {2, 3}, true)).positions, numpy_points);
    EXPECT_EQ(formats::read_npy("f", npy<float>("<f4", {}, {0, 3})).count(), 0U);
}

TEST(Npy, OtherShapesAndTypesAreRefused) {
    EXPECT_EQ(said_of_npy(npy<float>("<f4", {1, 2, 3, 4, 5, 6}, {3, 2})),
              "f: has the shape (3, 2); positions have (N, 3)");
    EXPECT_EQ(said_of_npy(npy<float>("<f4", {1, 2, 3}, {3})), "f: has the shape (3,); positions have (N, 3)");
    EXPECT_EQ(said_of_npy(npy<float>("|O", {}, {2, 3})), "f: holds pickled Python objects; positions are numbers");
    EXPECT_EQ(said_of_npy(npy<float>("<c8", {}, {2, 3})), "f: holds numbers of type 'c8'; positions are numbers");
    EXPECT_EQ(said_of_npy("abc"), "f: no numpy array: it does not begin with '\\x93NUMPY'");
}

TEST(Npy, ACountBeyondTheFileIsRefused) {
    EXPECT_NE(said_of_npy(npy<float>("<f4", {1, 2, 3}, {1000000000000, 3})).find("3000000000000 numbers"),
              std::string::npos);
    EXPECT_NE(said_of_npy(npy<float>("<f4", {1, 2, 3}, {std::size_t{1} << 62U, 12})).find("is announced"),
              std::string::npos);
    EXPECT_EQ(said_of_npy(npy<float>("<f4", {1, 2, 3, 4}, {1, 3})), "f: 4 bytes follow the array");
}

TEST(Npz, PositionsComeWithWhatElseHasARowForEach) {
    const auto bytes = npz([](formats::NpzWriter& out) {
        out.add("time", "<f4", {}, bytes_of({0.5F}));
        out.add("Speed", "<f4", {2}, bytes_of({7, 8}));
        out.add("positions", "<f4", {2, 3}, bytes_of(numpy_points));
        out.add("box", "<f4", {3, 2}, bytes_of(numpy_points));
        out.add("velocity", "<f4", {2, 3}, bytes_of(numpy_points));
        out.add("levels", "|u1", {2}, std::string("\3\1", 2));
    });
    const Particles particles = formats::read_npz("f", bytes, {});
    EXPECT_EQ(particles.positions, numpy_points);
    EXPECT_EQ(particles.levels, (std::vector<std::uint8_t>{3, 1}));
    ASSERT_EQ(particles.arrays.size(), 2U);
    EXPECT_EQ(particles.arrays[0].name, "speed");
    EXPECT_EQ(particles.arrays[1].name, "velocity");
    EXPECT_EQ(particles.arrays[1].components, 3U);
}

TEST(Npz, CoordinatesInArraysOfTheirOwnAreReadAsPySphNamesThem) {
    const auto bytes = npz([](formats::NpzWriter& out) {
        for (const auto& [name, first] :
             {std::pair{"x", 1.0F}, {"y", 2.0F}, {"z", 3.0F}, {"u", 7.0F}, {"v", 8.0F}, {"w", 9.0F}})
            out.add(name, "<f4", {2}, bytes_of({first, first + 3}));
        out.add("rho", "<f4", {2}, bytes_of({1000, 1001}));
    });
    const Particles particles = formats::read_npz("f", bytes, {});
    EXPECT_EQ(particles.positions, numpy_points);
    ASSERT_EQ(particles.arrays.size(), 2U);
    EXPECT_EQ(particles.arrays[0].name, "velocity");
    EXPECT_EQ(numbers_of<float>(particles.arrays[0]), (std::vector<float>{7, 8, 9, 10, 11, 12}));
    EXPECT_EQ(particles.arrays[1].name, "rho");
}

TEST(Npz, FilesWithoutPositionsAreRefusedWithTheReason) {
    EXPECT_EQ(said_of_npz(npz([](formats::NpzWriter& out) { out.add("a", "<f4", {1}, bytes_of({1})); })),
              "f: neither an array positions nor arrays x, y and z");
    EXPECT_EQ(said_of_npz(npz([](formats::NpzWriter& out) { out.add("objects", "|O", {}, "pickle"); })),
              "f: array 'objects': holds pickled Python objects, which are not read: save plain arrays, as "
              "numpy.savez(FILE, positions=..., velocity=...)");
    EXPECT_EQ(said_of_npz("PK"), "f: no zip file: it has no directory at its end");
}

TEST(Npz, DamageIsNoticed) {
    std::string bytes = npz([](formats::NpzWriter& out) {
        out.add("positions", "<f4", {2, 3}, bytes_of(numpy_points));
    });
    bytes[bytes.find("PK\1\2") - 3] ^= 1;
    EXPECT_EQ(said_of_npz(bytes),
              "f: array 'positions': member 'positions.npy' is damaged: its bytes do not have their checksum");
}

TEST(Npz, WhatItHoldsIsHeldAgainstTheLimit) {
    const std::string bytes = npz([](formats::NpzWriter& out) {
        out.add("positions", "<f4", {2, 3}, bytes_of(numpy_points));
    });
    EXPECT_EQ(formats::read_npz("f", bytes, {.most_bytes = bytes.size() + 24}).count(), 2U);
    const std::string message = refusal([&] { formats::read_npz("f", bytes, {.most_bytes = bytes.size() + 23}); });
    EXPECT_NE(message.find("24 bytes for what it holds, but only 23 are left"), std::string::npos) << message;
}

}  // namespace
}  // namespace meniscus::test
