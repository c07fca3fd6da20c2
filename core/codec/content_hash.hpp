// The identity of a brick's content.
#pragma once

#ifdef MENISCUS_XXHASH
#define XXH_INLINE_ALL
#include <xxhash.h>
#endif

#include <cstddef>
#include <cstdint>
#include <vector>

#ifndef MENISCUS_XXHASH
#include "lattice/word_hash.hpp"
#endif

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// 128 bits of xxHash over all that is added, with the lengths; in a build without xxHash the sums of packed bricks,
/// which take longer.
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
    void update(const void* bytes, std::size_t size);

#ifdef MENISCUS_XXHASH
    XXH3_state_t state_;
#else
    WordHash sums_{};
    std::uint64_t words_ = 0;  ///< number of words added
#endif
};

}  // namespace meniscus
