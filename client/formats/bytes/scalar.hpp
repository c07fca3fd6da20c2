// The numbers that binary files are made of.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace meniscus::formats {

enum class ScalarType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

constexpr std::size_t size_of(ScalarType type) {
    switch (type) {
        case ScalarType::int8:
        case ScalarType::uint8:
            return 1;
        case ScalarType::int16:
        case ScalarType::uint16:
            return 2;
        case ScalarType::int32:
        case ScalarType::uint32:
        case ScalarType::float32:
            return 4;
        case ScalarType::int64:
        case ScalarType::uint64:
        case ScalarType::float64:
            return 8;
    }
    return 0;
}

constexpr bool is_integer(ScalarType type) {
    return type != ScalarType::float32 && type != ScalarType::float64;
}

/// The sizeof(T) bytes at `bytes` as a T in the given byte order.
template <class T>
T load(const char* bytes, std::endian order) {
    char raw[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = bytes[order == std::endian::native ? i : sizeof(T) - 1 - i];
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
}

/// The size_of(type) bytes at `bytes` as a double; 64-bit integers beyond 2^53 are rounded.
inline double load_scalar(ScalarType type, const char* bytes, std::endian order) {
    switch (type) {
        case ScalarType::int8:
            return load<std::int8_t>(bytes, order);
        case ScalarType::uint8:
            return load<std::uint8_t>(bytes, order);
        case ScalarType::int16:
            return load<std::int16_t>(bytes, order);
        case ScalarType::uint16:
            return load<std::uint16_t>(bytes, order);
        case ScalarType::int32:
            return load<std::int32_t>(bytes, order);
        case ScalarType::uint32:
            return load<std::uint32_t>(bytes, order);
        case ScalarType::int64:
            return static_cast<double>(load<std::int64_t>(bytes, order));
        case ScalarType::uint64:
            return static_cast<double>(load<std::uint64_t>(bytes, order));
        case ScalarType::float32:
            return static_cast<double>(load<float>(bytes, order));
        case ScalarType::float64:
            return load<double>(bytes, order);
    }
    return 0.0;
}

/// Appends `value` in the given byte order.
template <class T>
void store(std::string& out, T value, std::endian order = std::endian::little) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (order != std::endian::native) std::reverse(raw, raw + sizeof(T));
    out.append(raw, sizeof(T));
}

/// The numbers of an array as bytes, where they lie.
template <class Number>
std::string_view bytes_of(const Number* numbers, std::size_t count) {
    return {reinterpret_cast<const char*>(numbers), count * sizeof(Number)};
}

}  // namespace meniscus::formats
