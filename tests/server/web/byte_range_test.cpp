// The header Range, by known answers and by what must hold for any text.
#include "web/byte_range.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace meniscus::server::test {
namespace {

/// "first+length", or "whole".
std::string range(const std::string& header, std::size_t size) {
    const auto found = byte_range(header, size);
    return found ? std::to_string(found->first) + '+' + std::to_string(found->length) : "whole";
}

TEST(ByteRange, HasKnownAnswers) {
    EXPECT_EQ(range("bytes=0-0", 10), "0+1");
    EXPECT_EQ(range("bytes=2-5", 10), "2+4");
    EXPECT_EQ(range("Bytes=2-", 10), "2+8");
    EXPECT_EQ(range("bytes=9-99", 10), "9+1");
    EXPECT_EQ(range("bytes=-3", 10), "7+3");
    EXPECT_EQ(range("bytes=-30", 10), "0+10");
    EXPECT_EQ(range("bytes=0-99999999999999999999999999", 10), "0+10");
    EXPECT_EQ(range("bytes=-99999999999999999999999999", 10), "0+10");
    for (const char* beyond : {"bytes=10-", "bytes=10-12", "bytes=-0", "bytes=99999999999999999999999999-"})
        EXPECT_EQ(range(beyond, 10).substr(range(beyond, 10).find('+')), "+0") << beyond;
    for (const char* none : {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-2", "bytes=0-1,3-4", "bytes= 0-1",
                             "bytes=0--1", "items=0-1", "bytes=+1-2", "bytes=0x1-2"})
        EXPECT_EQ(range(none, 10), "whole") << none;
}

TEST(ByteRange, LiesWithinTheFileForAnyText) {
    std::mt19937 random(1);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same texts each time
    const std::string letters = "0123456789-,= b";
    for (int i = 0; i < 100'000; ++i) {
        std::string text = i % 8 == 0 ? "" : "bytes=";
        for (std::size_t length = random() % 24; length > 0; --length) text += letters[random() % letters.size()];
        const std::size_t size = 1 + random() % 1000;
        const auto found = byte_range(text, size);
        if (!found) continue;
        ASSERT_LE(found->first, size) << text;
        ASSERT_LE(found->length, size - found->first) << text;
    }
}

}  // namespace
}  // namespace meniscus::server::test
