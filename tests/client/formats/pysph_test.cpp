// PySPH's .npz: pickles are read as values, and nothing in them is called.
#include <gtest/gtest.h>

#include <random>

#include "formats/containers/npz_writer.hpp"
#include "formats/containers/pickle.hpp"
#include "formats/containers/pysph_npz.hpp"
#include "formats/particles/particle_readers.hpp"
#include "formats/particles/particles.hpp"
#include "pysph_sample.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

const formats::ByteCursor pickle_place("f", {});

void read_pickle(const std::string& bytes, const formats::ReadLimits& limits = {}) {
    formats::ReadBudget budget(limits, 0, pickle_place);
    formats::Pickle(pickle_place, bytes, budget);
}

std::vector<formats::NamedNpyArray> arrays_of(const std::string& pickled) {
    formats::ReadBudget budget({}, 0, pickle_place);
    return formats::pysph_arrays(pickle_place, pickled, budget);
}

TEST(PySph, ArraysAreThoseOfTheFluidOrOfTheOnlyKind) {
    for (const char* kind : {"fluid", "solid"}) {
        const std::string pickled = sample_pickle(kind);
        const auto arrays = arrays_of(pickled);
        ASSERT_EQ(arrays.size(), 5U) << kind;
        EXPECT_EQ(arrays[0].name, "x");
        EXPECT_EQ(arrays[0].array.type, formats::ScalarType::float64);
        EXPECT_EQ(arrays[0].array.shape, std::vector<std::size_t>{2});
        EXPECT_EQ(arrays[0].array.at(1, 0), 2.0);
        EXPECT_EQ(arrays[3].name, "gid");
        EXPECT_EQ(arrays[3].array.at(1, 0), 9.0);
    }
}

TEST(PySph, OtherPicklesAreRefusedWithWhatToDo) {
    const auto message = [](const std::string& bytes) { return refusal([&] { arrays_of(bytes); }); };
    EXPECT_NE(message("\x80\x03N.").find("save plain arrays"), std::string::npos);
    EXPECT_NE(message("").find("truncated"), std::string::npos);
    EXPECT_NE(message("\x80\x03Z.").find("operation 90 at byte 2"), std::string::npos) << message("\x80\x03Z.");
    EXPECT_NE(message("0.").find("takes a value where there is none"), std::string::npos);
    std::string longer = sample_pickle();
    longer.replace(longer.find(small(2) + "\x85"), 2, small(3));
    EXPECT_NE(message(longer).find("of shape (3,) has 16 bytes"), std::string::npos) << message(longer);
}

TEST(PySph, PositionsAndArraysComeOutOfTheZippedPickle) {
    const formats::Particles particles = formats::read_npz("f", sample_pysph_npz(), {});
    EXPECT_EQ(particles.positions, (std::vector<float>{1, 3, 5, 2, 4, 6}));
    ASSERT_EQ(particles.arrays.size(), 2U);
    EXPECT_EQ(particles.arrays[0].name, "gid");
    EXPECT_EQ(particles.arrays[0].type, ElementType::uint32);
    // Six numbers of two particles, one after the other.
    EXPECT_EQ(particles.arrays[1].name, "dw");
    EXPECT_EQ(particles.arrays[1].components, 3U);
    EXPECT_EQ(particles.arrays[1].count(), 2U);
}

TEST(Pickle, TakesNoMoreThanAMillionValues) {
    EXPECT_NE(refusal([] { read_pickle(std::string(1'000'001, 'N')); }).find("more than"), std::string::npos);
    // A list that doubles itself again and again.
    std::string bomb = "]q";
    bomb += '\0';
    for (int i = 0; i < 1'000'000; ++i) bomb += std::string("h\0a", 3);
    EXPECT_EQ(refusal([&] { read_pickle(bomb + "."); }), "");
    const std::string again = bomb.substr(3);
    EXPECT_NE(refusal([&] { read_pickle(bomb + again + again + again + again + "."); }).find("items"),
              std::string::npos);
}

TEST(Pickle, WhatItsValuesTakeIsHeldAgainstTheLimit) {
    const std::string message = refusal([] { read_pickle(std::string(10'000, 'N') + ".", {.most_bytes = 100'000}); });
    EXPECT_NE(message.find("bytes for its pickle, but only"), std::string::npos) << message;
    EXPECT_EQ(refusal([] { read_pickle(std::string(1'000, 'N') + ".", {.most_bytes = 100'000}); }), "");
    // A value that is kept under one number after the other.
    EXPECT_NE(refusal([] {
                  read_pickle("N" + std::string(10'000, '\x94') + ".", {.most_bytes = 100'000});
              }).find("bytes for its pickle, but only"),
              std::string::npos);
}

TEST(Pickle, SurvivesChangedBytes) {
    std::mt19937 random(4);
    const std::string sample = sample_pickle();
    for (int round = 0; round < 5000; ++round) {
        std::string bytes = sample;
        for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips)
            bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
        const std::string message = refusal([&] { arrays_of(bytes); });
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    for (std::size_t size = 0; size < sample.size(); ++size)
        EXPECT_NE(refusal([&] { arrays_of(sample.substr(0, size)); }), "");
}

}  // namespace
}  // namespace meniscus::test
