// DualSPHysics: files made by the layout.
#include <gtest/gtest.h>

#include "bi4_sample.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/particles/particles.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::test {
namespace {

std::string said_of_bi4(const std::string& bytes) {
    return refusal([&] { formats::read_bi4("f", bytes); });
}

TEST(Bi4, TheFluidIsReadInBothByteOrdersAndWidthsOfSizes) {
    for (const Bi4 form : {Bi4{}, Bi4{std::endian::big, false}, Bi4{std::endian::little, true}}) {
        const formats::Particles particles = formats::read_bi4("f", form.sample());
        EXPECT_EQ(particles.positions, (std::vector<float>{1, 2, 3, 4, 5, 6}));
        ASSERT_EQ(particles.arrays.size(), 3U);
        EXPECT_EQ(particles.arrays[0].name, "id");
        EXPECT_EQ(particles.arrays[0].type, ElementType::uint32);
        EXPECT_EQ(numbers_of<std::uint32_t>(particles.arrays[0]), (std::vector<std::uint32_t>{9, 5}));
        EXPECT_EQ(particles.arrays[1].name, "velocity");
        EXPECT_EQ(numbers_of<float>(particles.arrays[1]), (std::vector<float>{10, 20, 30, 40, 50, 60}));
        EXPECT_EQ(particles.arrays[2].name, "density");
        EXPECT_EQ(numbers_of<float>(particles.arrays[2]), (std::vector<float>{1000, 1001}));
    }
}

TEST(Bi4, PositionsOfFloat64AndIdsOf64BitsAreRead) {
    const Bi4 form;
    const formats::Particles particles = formats::read_bi4(
        "f", form.file(1, {form.array("Idpd", 10, 2, form.numbers<std::uint64_t>({0, 4'000'000'000ULL})),
                           form.array("Posd", 23, 2, form.numbers<double>({1, 2, 3, 0.1, 5, 6}))}));
    EXPECT_EQ(particles.positions, (std::vector<float>{0.1F, 5, 6}));
    EXPECT_NEAR(particles.coordinate(0), 0.1, 1e-15) << "an origin is subtracted from float64";
    ASSERT_EQ(particles.arrays.size(), 1U);
    EXPECT_EQ(numbers_of<std::uint32_t>(particles.arrays[0]), std::vector<std::uint32_t>{4'000'000'000U});
}

TEST(Bi4, ArraysOfOtherFormsAreLeftOutWithTheReason) {
    const Bi4 form;
    const formats::Particles particles =
        formats::read_bi4("f", form.file(0, {form.array("Names", 1, 1, form.text("a")),
                                             form.array("Pos", 22, 1, form.numbers<float>({1, 2, 3})),
                                             form.array("Mass", 11, 2, form.numbers<float>({1, 2}))}));
    EXPECT_EQ(particles.count(), 1U);
    ASSERT_EQ(particles.left_out.size(), 2U);
    EXPECT_EQ(particles.left_out[0], "names (texts)");
    EXPECT_EQ(particles.left_out[1], "mass (2 values for 1 particles)");
}

TEST(Bi4, WrongFilesAreRefusedWithTheReason) {
    const Bi4 form;
    EXPECT_EQ(said_of_bi4("text"), "f: not a file of DualSPHysics: it does not begin with '#FileJBD'");
    EXPECT_EQ(said_of_bi4(form.file(0, {})), "f: has no array Pos or Posd");
    EXPECT_NE(said_of_bi4(form.file(0, {form.array("Pos", 22, 7, form.numbers<float>({1, 2, 3}))})).find("f: "),
              std::string::npos);
    EXPECT_EQ(said_of_bi4(form.file(0, {form.array("Pos", 22, 1, form.numbers<float>({1, 2, 3, 4}))})),
              "f: array 'Pos' has 1 values of 12 bytes in 16 bytes");
    EXPECT_EQ(said_of_bi4(form.file(0, {form.array("Pos", 11, 1, form.numbers<float>({1}))})),
              "f: array 'Pos' has no three coordinates a particle");
    EXPECT_EQ(said_of_bi4(form.file(0, {form.array("Pos", 13, 1, form.numbers<float>({1}))})),
              "f: array 'Pos' has the unknown type 13");
    std::string order = form.sample();
    order[60] = 7;
    EXPECT_EQ(said_of_bi4(order), "f: byte 60, the byte order, is 7, none of 0, 1, 10 and 11");
    for (const std::string& pieces :
         {form.value("Npiece", 8, form.number(2)), form.value("Npiece", 12, form.numbers<double>({1e300}))})
        EXPECT_EQ(said_of_bi4(form.header() + form.item("a", {pieces}, {}, {})),
                  "f: is one of several pieces of a step; steps in one piece are read");
    const std::string step = form.item("p", {}, {form.array("Pos", 22, 1, form.numbers<float>({1, 2, 3}))}, {});
    EXPECT_EQ(said_of_bi4(form.header() + form.item("a", {}, {}, {step, step})),
              "f: has several steps; one is read: give it a file of its own");
    std::string nested = form.item("p", {}, {}, {});
    for (int i = 0; i < 100; ++i) nested = form.item("p", {}, {}, {nested});
    EXPECT_EQ(said_of_bi4(form.header() + nested), "f: has items within items more than 16 deep");
    const Bi4 wide{std::endian::little, true};
    EXPECT_NE(said_of_bi4(wide.file(0, {wide.array("Pos", 22, std::uint64_t{1} << 62, "")})), "");
}

}  // namespace
}  // namespace meniscus::test
