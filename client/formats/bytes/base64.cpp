#include "formats/bytes/base64.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace meniscus::formats {
namespace {

constexpr std::uint8_t no_digit = 64;

constexpr auto digits = [] {
    std::array<std::uint8_t, 256> values{};
    values.fill(no_digit);
    std::uint8_t value = 0;
    for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"))
        values[static_cast<unsigned char>(c)] = value++;
    return values;
}();

}  // namespace

std::string Base64Reader::take(std::size_t size, const ByteCursor& at, std::string_view what) {
    std::string out;
    out.reserve(std::min(size, most()));
    while (out.size() < size) {
        if (ready_.empty()) take_plain_groups(out, size);
        if (out.size() == size) break;
        if (ready_.empty()) decode(at, what);
        const std::size_t taken = std::min(size - out.size(), ready_.size());
        out.append(ready_, 0, taken);
        ready_.erase(0, taken);
    }
    return out;
}

void Base64Reader::take_plain_groups(std::string& out, std::size_t size) {
    while (size - out.size() >= 3 && text_.size() >= 4) {
        std::uint32_t bits = 0, all = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint32_t digit = digits[static_cast<unsigned char>(text_[i])];
            bits = bits << 6U | digit;
            all |= digit;
        }
        if (all >= no_digit) return;
        const std::array bytes{static_cast<char>(bits >> 16U), static_cast<char>(bits >> 8U & 0xFFU),
                               static_cast<char>(bits & 0xFFU)};
        out.append(bytes.data(), bytes.size());
        text_.remove_prefix(4);
    }
}

void Base64Reader::decode(const ByteCursor& at, std::string_view what) {
    std::uint32_t bits = 0;
    int characters = 0, padding = 0;
    while (characters < 4) {
        if (text_.empty()) at.fail(std::string(what) + " ends before its base64 data do");
        const char c = text_.front();
        text_.remove_prefix(1);
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        const std::uint8_t digit = digits[static_cast<unsigned char>(c)];
        if (c == '=' && characters >= 2)
            ++padding;
        else if (digit == no_digit || padding > 0)
            at.fail(std::string(what) + ": " + quoted({&c, 1}) + " is no digit of base64 here");
        bits = bits << 6U | (c == '=' ? 0U : std::uint32_t{digit});
        ++characters;
    }
    for (int i = 0; i < 3 - padding; ++i) ready_ += static_cast<char>(bits >> (16 - 8 * i) & 0xFFU);
}

}  // namespace meniscus::formats
