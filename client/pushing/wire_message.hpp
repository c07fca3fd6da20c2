// A message of Protocol Buffers, written without Protocol Buffers.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "meniscus/element_type.hpp"

namespace meniscus::pushing {

static_assert(std::endian::native == std::endian::little, "numbers travel as they lie in memory");

/// A message under construction. Fields of the value 0 are left out, as Protocol Buffers does.
class Message {
public:
    Message& number(unsigned field, std::uint64_t value) { return value == 0 ? *this : present(field, value); }
    /// Also 0, which differs from a number that is not set.
    Message& present(unsigned field, std::uint64_t value) {
        tag(field, 0);
        varint(value);
        return *this;
    }
    Message& real(unsigned field, double value) {
        std::array<char, sizeof value> bytes{};
        std::memcpy(bytes.data(), &value, sizeof value);
        if (std::all_of(bytes.begin(), bytes.end(), [](char byte) { return byte == 0; })) return *this;
        tag(field, 1);
        bytes_.append(bytes.data(), bytes.size());
        return *this;
    }
    /// Zigzag, as sint32.
    Message& signed_number(unsigned field, std::int32_t value) {
        return number(field, (static_cast<std::uint32_t>(value) << 1U) ^ (value < 0 ? 0xFFFFFFFFU : 0U));
    }
    Message& text(unsigned field, std::string_view value) {
        length(field, value.size());
        bytes_ += value;
        return *this;
    }
    /// Numbers as they lie in memory, one behind the other; none of an empty list.
    template <class Number>
    Message& packed(unsigned field, std::span<const Number> values) {
        if (values.empty()) return *this;
        return text(field, {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    }
    Message& message(unsigned field, const Message& value) { return text(field, value.bytes_); }
    /// The tag and the length of a field whose bytes follow elsewhere.
    Message& length(unsigned field, std::size_t bytes) {
        tag(field, 2);
        varint(bytes);
        return *this;
    }

    /// After its length, of which `more` bytes follow elsewhere.
    std::string delimited(std::size_t more = 0) const {
        Message out;
        out.varint(bytes_.size() + more);
        return out.bytes_ + bytes_;
    }
    const std::string& bytes() const { return bytes_; }
    std::size_t size() const { return bytes_.size(); }

private:
    void tag(unsigned field, unsigned wire) { varint(field << 3U | wire); }
    void varint(std::uint64_t value) {
        constexpr std::uint64_t more = 0x80;
        for (; value >= more; value >>= 7U) bytes_ += static_cast<char>(value | more);
        bytes_ += static_cast<char>(value);
    }

    std::string bytes_;
};

/// The number that ElementType and AttributeType have for it.
inline std::uint64_t wire_type(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return 1;
        case ElementType::uint8:
            return 2;
        case ElementType::int32:
            return 4;
        case ElementType::uint32:
            return 5;
    }
    return 0;
}

}  // namespace meniscus::pushing
