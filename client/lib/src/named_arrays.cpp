#include "named_arrays.hpp"

#include <algorithm>
#include <string_view>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::client {

namespace {

const ParticleArray* find_once(std::span<const ParticleArray> arrays, std::string_view name) {
    const auto array = std::ranges::find(arrays, name, &ParticleArray::name);
    if (array == arrays.end()) return nullptr;
    if (std::ranges::count(arrays, name, &ParticleArray::name) > 1)
        throw InvalidInput("array " + quoted(name) + " comes twice; each comes once");
    return &*array;
}

void require_form(const ParticleArray& array) {
    if (can_be_attribute(array.type, array.components)) return;
    throw InvalidInput("array " + quoted(array.name) + " is " + form_of(array.type, array.components) +
                       "; an attribute is " + std::string(attribute_forms));
}

bool can_be_named(std::string_view name) {
    const auto is_allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    return !name.empty() && name.size() <= max_array_name_bytes && std::ranges::all_of(name, is_allowed) &&
           name != "position" && name != "level";
}

}  // namespace

std::vector<ParticleArray> NamedArrays::of(std::span<const ParticleArray> arrays, std::size_t particles) const {
    if (!names_ || all_) return every(arrays);
    std::vector<ParticleArray> named;
    for (const std::string& name : *names_) {
        const ParticleArray* const array = find_once(arrays, name);
        if (array == nullptr && particles == 0) return {};
        if (array == nullptr)
            throw InvalidInput("no array " + quoted(name) +
                               ", which the session's settings name among the attributes; each frame must bring it");
        require_form(*array);
        named.push_back(*array);
    }
    return named;
}

std::vector<ParticleArray> NamedArrays::every(std::span<const ParticleArray> arrays) const {
    std::vector<ParticleArray> all;
    for (const ParticleArray& array : arrays) {
        if (all_ && !can_be_named(array.name))
            throw InvalidInput("an array is named " + quoted(array.name) +
                               "; names have 1 to 64 of a-z, 0-9 and _, and are not position or level");
        if (all_) require_form(array);
        if (!can_be_named(array.name) || !can_be_attribute(array.type, array.components)) continue;
        find_once(arrays, array.name);
        all.push_back(array);
    }
    return all;
}

}  // namespace meniscus::client
