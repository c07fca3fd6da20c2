// Brick contents are compared by 128 bits of xxHash: two with the same hash would leave every watcher a stale brick.
#include "codec/content_hash.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace meniscus {

ContentHasher::ContentHasher() {
    XXH3_128bits_reset(&state_);
}

void ContentHasher::add_bytes(const void* bytes, std::size_t count, std::size_t size) {
    const std::uint64_t number = count;
    XXH3_128bits_update(&state_, &number, sizeof number);
    XXH3_128bits_update(&state_, bytes, size);
}

void ContentHasher::add(const std::vector<CodedAttribute>& forms) {
    for (const CodedAttribute& form : forms) {
        const std::array<std::uint64_t, 4> numbers{form.name.size(), static_cast<std::uint64_t>(form.type),
                                                   form.components, static_cast<std::uint64_t>(form.bits)};
        XXH3_128bits_update(&state_, numbers.data(), sizeof numbers);
        XXH3_128bits_update(&state_, form.name.data(), form.name.size());
        XXH3_128bits_update(&state_, form.minimum.data(), sizeof form.minimum);
        XXH3_128bits_update(&state_, form.maximum.data(), sizeof form.maximum);
    }
}

ContentHash ContentHasher::hash() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return {hash.high64, hash.low64};
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
