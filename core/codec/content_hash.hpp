// The identity of a brick's content.
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// 128 bits of xxHash over all that is added, with the lengths.
class ContentHasher {
public:
    ContentHasher();
    template <class T>
    void add(const T* values, std::size_t count) {
        add_bytes(values, count, count * sizeof(T));
    }
    void add(const std::vector<CodedAttribute>& forms);
    ContentHash hash() const;

private:
    void add_bytes(const void* bytes, std::size_t count, std::size_t size);
    XXH3_state_t state_;
};

}  // namespace meniscus
