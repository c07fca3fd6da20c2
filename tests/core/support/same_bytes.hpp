// Whether two arrays are the same, to the bit.
#pragma once

#include <cstring>

#include "meniscus/memory.hpp"

namespace meniscus::test {

template <class T>
bool same_bytes(const Array<T>& a, const Array<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace meniscus::test
