// PySPH's .npz: pickles are read as values, and nothing in them is called.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "formats/pickle.hpp"
#include "formats/pysph_npz.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

std::string short_text(const std::string& text) {
    return std::string("X") + static_cast<char>(text.size()) + std::string(3, '\0') + text;
}
std::string small(int number) {
    return std::string("K") + static_cast<char>(number);
}

/// As Python pickles numpy.array(numbers): a call, its arguments, and a state.
std::string numpy_array(const std::string& type, int count, const std::string& data) {
    const std::string call = std::string("cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n") + small(0) +
                             "\x85" + std::string("C\x01") + "b" + "\x87" + "R";
    const std::string dtype = std::string("cnumpy\ndtype\n") + short_text(type) + "\x89\x88\x87R(" + small(3) +
                              short_text("<") + "NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xff" + small(0) + "tb";
    return call + "(" + small(1) + small(count) + "\x85" + dtype + "\x89" + "C" + static_cast<char>(data.size()) +
           data + "tb";
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    std::string out(values.size() * sizeof(T), '\0');
    std::memcpy(out.data(), values.data(), out.size());
    return out;
}

/// Two particles of one kind. object: in the array of one object as which numpy keeps a dictionary.
std::string sample_pickle(const std::string& kind = "fluid") {
    const std::string arrays = std::string("}(") + short_text("x") +
                               numpy_array("f8", 2, bytes_of<double>({1.0, 2.0})) + short_text("gid") +
                               numpy_array("u4", 2, bytes_of<std::uint32_t>({7, 9})) + "u";
    const std::string kinds = "}" + short_text(kind) + "}" + short_text("arrays") + arrays + "ss";
    const std::string dtype =
        std::string("cnumpy\ndtype\n") + short_text("O8") + "\x89\x88\x87R(" + small(3) + short_text("|") + "tb";
    return std::string("\x80\x03") + "cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n" + small(0) + "\x85" +
           std::string("C\x01") + "b" + "\x87" + "R(" + small(1) + ")" + dtype + "\x89]" + kinds + "atb.";
}

std::vector<formats::NamedNpyArray> arrays_of(const std::string& pickled) {
    return formats::pysph_arrays(formats::ByteCursor("f", {}), pickled);
}

TEST(PySph, ArraysAreThoseOfTheFluidOrOfTheOnlyKind) {
    for (const char* kind : {"fluid", "solid"}) {
        const std::string pickled = sample_pickle(kind);
        const auto arrays = arrays_of(pickled);
        ASSERT_EQ(arrays.size(), 2U) << kind;
        EXPECT_EQ(arrays[0].name, "x");
        EXPECT_EQ(arrays[0].array.type, formats::ScalarType::float64);
        EXPECT_EQ(arrays[0].array.shape, std::vector<std::size_t>{2});
        EXPECT_EQ(arrays[0].array.at(1, 0), 2.0);
        EXPECT_EQ(arrays[1].name, "gid");
        EXPECT_EQ(arrays[1].array.at(1, 0), 9.0);
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

TEST(Pickle, TakesNoMoreThanAMillionValues) {
    EXPECT_NE(
        refusal([] { formats::Pickle(formats::ByteCursor("f", {}), std::string(1'000'001, 'N')); }).find("more than"),
        std::string::npos);
    // A list that doubles itself again and again.
    std::string bomb = "]q";
    bomb += '\0';
    for (int i = 0; i < 1'000'000; ++i) bomb += std::string("h\0a", 3);
    EXPECT_EQ(refusal([&] { formats::Pickle(formats::ByteCursor("f", {}), bomb + "."); }), "");
    EXPECT_NE(refusal([&] {
                  formats::Pickle(formats::ByteCursor("f", {}), bomb + bomb.substr(3) + bomb.substr(3) + bomb.substr(3) + bomb.substr(3) + ".");
              }).find("items"),
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
