// Structs that a caller may have compiled with another version of the header: shorter, or longer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

#include "meniscus/error.hpp"
#include "meniscus/meniscus.h"
#include "result.hpp"

namespace meniscus::c {

/// The size of a struct in the first version; a struct that grows gets a specialization with the size that it had. None
/// has grown twice: between this and its present size there is no version's, and the end might lie within a member.
template <class Struct>
inline constexpr std::size_t least_size = sizeof(Struct);
template <>
inline constexpr std::size_t least_size<meniscus_particles> = offsetof(meniscus_particles, array_count);
template <>
inline constexpr std::size_t least_size<meniscus_statistics> = offsetof(meniscus_statistics,
                                                                        vertices_without_particles);
/// The largest size of any version's struct: a larger one was not set.
inline constexpr std::size_t most_size = 4096;

template <class Struct>
std::size_t checked_size(const Struct& given, const char* name) {
    const bool known = given.struct_size == least_size<Struct> ||
                       (given.struct_size >= sizeof(Struct) && given.struct_size <= most_size);
    if (!known)
        throw InvalidInput(std::string(name) + "->struct_size is " + std::to_string(given.struct_size) +
                           ", must be sizeof(meniscus_" + name + "), here " + std::to_string(sizeof(Struct)));
    return given.struct_size;
}

/// A caller's struct. What this version does not know must be 0.
template <class Struct>
Struct read_struct(const Struct* from, const char* name) {
    static_assert(std::is_trivially_copyable_v<Struct>);
    const std::size_t size = checked_size(required(from, name), name);
    const auto* const bytes = reinterpret_cast<const unsigned char*>(from);
    if (size > sizeof(Struct) && std::any_of(bytes + sizeof(Struct), bytes + size, [](auto byte) { return byte != 0; }))
        throw InvalidInput(std::string(name) + " uses members that this version of the library does not know");
    Struct value{};
    std::memcpy(&value, from, std::min(size, sizeof(Struct)));
    return value;
}

/// To the caller: as much as its struct has room for. What this version does not know becomes 0.
template <class Struct>
void write_struct(const Struct& value, Struct* to, const char* name) {
    static_assert(std::is_trivially_copyable_v<Struct>);
    const std::size_t size = checked_size(required(to, name), name);
    auto* const bytes = reinterpret_cast<unsigned char*>(to);
    std::memcpy(bytes, &value, std::min(size, sizeof(Struct)));
    if (size > sizeof(Struct)) std::memset(bytes + sizeof(Struct), 0, size - sizeof(Struct));
    to->struct_size = size;
}

}  // namespace meniscus::c
