// Whether two arrays are the same, to the bit.
#pragma once

#include <cstring>

#include "meniscus/memory.hpp"

namespace meniscus::test {

template <class T>
bool same_bytes(const Array<T>& a, const Array<T>& b) {
    if (a.size() != b.size()) return false;
    return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace meniscus::test
