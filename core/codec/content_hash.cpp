// Brick contents are compared by 128 bits of a hash: two with the same hash would leave every watcher a stale brick.
#include "codec/content_hash.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace meniscus {

#ifdef MENISCUS_XXHASH

ContentHasher::ContentHasher() {
    XXH3_128bits_reset(&state_);
}

void ContentHasher::update(const void* bytes, std::size_t size) {
    XXH3_128bits_update(&state_, bytes, size);
}

ContentHash ContentHasher::hash() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return {hash.high64, hash.low64};
}

#else

ContentHasher::ContentHasher() = default;

/// The last word is filled up with zeros: lengths are added before what has them.
void ContentHasher::update(const void* bytes, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(bytes);
    for (std::size_t at = 0; at < size; at += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, first + at, std::min(sizeof word, size - at));
        sums_.add(word, words_++);
    }
}

ContentHash ContentHasher::hash() const {
    return {sums_.of[0], sums_.of[1]};
}

#endif

void ContentHasher::add_bytes(const void* bytes, std::size_t count, std::size_t size) {
    const std::uint64_t number = count;
    update(&number, sizeof number);
    update(bytes, size);
}

void ContentHasher::add(const std::vector<CodedAttribute>& forms) {
    for (const CodedAttribute& form : forms) {
        const std::array<std::uint64_t, 4> numbers{form.name.size(), static_cast<std::uint64_t>(form.type),
                                                   form.components, static_cast<std::uint64_t>(form.bits)};
        update(numbers.data(), sizeof numbers);
        update(form.name.data(), form.name.size());
        update(form.minimum.data(), sizeof form.minimum);
        update(form.maximum.data(), sizeof form.maximum);
    }
}

ContentHash BrickContent::hash() const {
    ContentHasher hasher;
    const auto add = [&hasher](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, Normal>);
        hasher.add(values.data(), values.size());
    };
    add(positions);
    add(normals);
    add(triangles);
    add(cell_levels);
    hasher.add(attribute_forms);
    for (const std::vector<std::byte>& values : attributes) add(values);
    return hasher.hash();
}

}  // namespace meniscus
