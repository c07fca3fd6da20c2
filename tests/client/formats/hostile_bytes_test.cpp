// Whatever the bytes, a reader answers or refuses in one line; it never crashes and never believes an announced count.
#include <gtest/gtest.h>

#include <random>

#include "meniscus/error.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

/// Runs the reader; a refusal must be one line that names the file.
void survive(const Sample& sample, const std::string& bytes) {
    const std::string message = refusal([&] { sample.read(bytes); });
    if (message.empty()) return;
    EXPECT_EQ(message.rfind("sample: ", 0), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(Readers, AcceptEverySample) {
    for (const Sample& sample : samples()) EXPECT_EQ(refusal([&] { sample.read(sample.bytes); }), "") << sample.name;
}

TEST(Readers, SurviveEveryPrefix) {
    for (const Sample& sample : samples())
        for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
            SCOPED_TRACE(sample.name + ", first " + std::to_string(size) + " bytes");
            survive(sample, sample.bytes.substr(0, size));
        }
}

TEST(Readers, SurviveRandomBytesInTheMiddle) {
    std::mt19937 random(1);
    for (const Sample& sample : samples())
        for (int round = 0; round < 4000; ++round) {
            std::string bytes = sample.bytes;
            for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips)
                bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
            SCOPED_TRACE(sample.name + ", round " + std::to_string(round));
            survive(sample, bytes);
        }
}

TEST(Readers, SurviveDigitsThatLie) {
    for (const Sample& sample : samples())
        for (std::size_t i = 0; i < sample.bytes.size(); ++i) {
            if (sample.bytes[i] < '0' || sample.bytes[i] > '9') continue;
            for (const char* lie :
                 {"99999999999999999999", "18446744073709551615", "4611686018427387904", "-1", "1000000000", "0"}) {
                std::string bytes = sample.bytes;
                bytes.replace(i, 1, lie);
                SCOPED_TRACE(sample.name + ", " + lie + " at " + std::to_string(i));
                survive(sample, bytes);
            }
        }
}

TEST(Readers, SurviveNoise) {
    std::mt19937 random(2);
    for (const Sample& sample : samples())
        for (std::size_t size = 0; size < 200; ++size) {
            std::string bytes(size, '\0');
            for (char& c : bytes) c = static_cast<char>(random() % 256);
            survive(sample, bytes);
        }
}

}  // namespace
}  // namespace meniscus::test
