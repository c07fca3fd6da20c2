// Brick contents are compared by 128 bits of xxHash: two with the same hash would leave every watcher a stale brick.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <span>
#include <type_traits>

#include "meniscus/brick_coding.hpp"

namespace meniscus {
namespace {

template <class T>
void add(XXH3_state_t& state, const std::vector<T>& values) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, Normal>);
    const std::uint64_t count = values.size();
    XXH3_128bits_update(&state, &count, sizeof count);
    XXH3_128bits_update(&state, values.data(), std::span(values).size_bytes());
}

void add(XXH3_state_t& state, const CodedAttribute& form) {
    const std::array<std::uint64_t, 4> numbers{form.name.size(), static_cast<std::uint64_t>(form.type), form.components,
                                               static_cast<std::uint64_t>(form.bits)};
    XXH3_128bits_update(&state, numbers.data(), sizeof numbers);
    XXH3_128bits_update(&state, form.name.data(), form.name.size());
    XXH3_128bits_update(&state, form.minimum.data(), sizeof form.minimum);
    XXH3_128bits_update(&state, form.maximum.data(), sizeof form.maximum);
}

}  // namespace

ContentHash BrickContent::hash() const {
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    add(state, positions);
    add(state, normals);
    add(state, triangles);
    add(state, cell_levels);
    for (const CodedAttribute& form : attribute_forms) add(state, form);
    for (const std::vector<std::byte>& values : attributes) add(state, values);
    const XXH128_hash_t hash = XXH3_128bits_digest(&state);
    return {hash.high64, hash.low64};
}

}  // namespace meniscus
