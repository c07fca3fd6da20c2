// Whether two ranges of memory have bytes in common.
#pragma once

#include <cstddef>
#include <span>

namespace meniscus::test {

template <class T>
bool overlaps(const T& array, const void* begin, std::size_t bytes) {
    const auto span = std::as_bytes(std::span(array));
    const auto* const at = static_cast<const std::byte*>(begin);
    return at < span.data() + span.size() && span.data() < at + bytes;
}

}  // namespace meniscus::test
