#include "files/delimited_messages.hpp"

#include <algorithm>

namespace meniscus::files {

std::optional<std::string> DelimitedMessages::next(std::size_t limit) {
    constexpr std::uint64_t longest_varint = 5;  // of lengths up to 2^35: the limits are far below
    const std::string digits =
        file_->read(position_, static_cast<std::size_t>(std::min(longest_varint, end_ - position_)));
    std::uint64_t size = 0;
    std::size_t used = 0;
    for (bool more = true; more; ++used) {
        if (used == longest_varint) file_->fail("no message at byte " + std::to_string(position_));
        if (used == digits.size()) return std::nullopt;
        const auto digit = static_cast<unsigned char>(digits[used]);
        size |= std::uint64_t{digit & 0x7fU} << (7 * used);
        more = digit >= 0x80U;
    }
    if (size > limit)
        file_->fail("a message of " + std::to_string(size) + " bytes at byte " + std::to_string(position_) +
                    "; at most " + std::to_string(limit) + " are expected there");
    const std::uint64_t first = position_ + used;
    if (size > end_ - first) return std::nullopt;
    position_ = first + size;
    return file_->read(first, static_cast<std::size_t>(size));
}

}  // namespace meniscus::files
