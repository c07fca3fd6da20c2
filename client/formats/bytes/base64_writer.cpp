#include "formats/bytes/base64_writer.hpp"

#include <algorithm>
#include <cstdint>

namespace meniscus::formats {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Groups of three bytes that are encoded at once, in a buffer of 4 KiB.
constexpr std::size_t groups_at_once = 1024;

void encode(const char* group, char* text) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) bits = bits << 8U | static_cast<unsigned char>(group[i]);
    for (std::size_t i = 0; i < 4; ++i) text[i] = digits[bits >> (18 - 6 * i) & 63U];
}

}  // namespace

void Base64Writer::write(std::string_view bytes) {
    while (count_ > 0 && count_ < 3 && !bytes.empty()) {
        waiting_[count_++] = bytes.front();
        bytes.remove_prefix(1);
    }
    std::array<char, 4 * groups_at_once> text;
    if (count_ == 3) {
        encode(waiting_.data(), text.data());
        out_.write({text.data(), 4});
        count_ = 0;
    }
    while (bytes.size() >= 3) {
        const std::size_t groups = std::min(bytes.size() / 3, groups_at_once);
        for (std::size_t i = 0; i < groups; ++i) encode(bytes.data() + 3 * i, text.data() + 4 * i);
        out_.write({text.data(), 4 * groups});
        bytes.remove_prefix(3 * groups);
    }
    for (const char byte : bytes) waiting_[count_++] = byte;
}

void Base64Writer::finish() {
    if (count_ == 0) return;
    std::array<char, 4> text;
    std::fill(waiting_.begin() + static_cast<std::ptrdiff_t>(count_), waiting_.end(), '\0');
    encode(waiting_.data(), text.data());
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(count_) + 1, text.end(), '=');
    out_.write({text.data(), 4});
    count_ = 0;
}

}  // namespace meniscus::formats
