#include "particles.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "sized_struct.hpp"

namespace meniscus::c {
namespace {

template <class Number>
bool has_axes(const Number* const (&axes)[3]) {
    return axes[0] != nullptr || axes[1] != nullptr || axes[2] != nullptr;
}

void require_one_kind_of_positions(const meniscus_particles& given) {
    const std::array<std::pair<const char*, bool>, 4> kinds{{{"positions", given.positions != nullptr},
                                                             {"positions_double", given.positions_double != nullptr},
                                                             {"axes", has_axes(given.axes)},
                                                             {"axes_double", has_axes(given.axes_double)}}};
    const auto is_set = [](const auto& kind) { return kind.second; };
    const auto* const first = std::find_if(kinds.begin(), kinds.end(), is_set);
    const auto* const second = first == kinds.end() ? first : std::find_if(first + 1, kinds.end(), is_set);
    if (first != kinds.end() && second == kinds.end()) return;
    const std::string what =
        first == kinds.end() ? "particles->positions, positions_double, axes and axes_double are all NULL"
                             : std::string("particles->") + first->first + " and " + second->first + " are both set";
    throw InvalidInput(what + ", must be one of them, for " + std::to_string(given.count) + " particles");
}

/// The struct itself, once it makes sense.
meniscus_particles checked(const meniscus_particles* particles) {
    const meniscus_particles given = read_struct(particles, "particles");
    constexpr std::size_t most = std::numeric_limits<std::ptrdiff_t>::max() / (3 * sizeof(double));
    if (given.count > most)
        throw InvalidInput("particles->count is " + std::to_string(given.count) + ", more than memory can hold");
    if (given.count != 0) require_one_kind_of_positions(given);
    return given;
}

template <class Number>
StridedPositions strided(const Number* first, const meniscus_particles& given) {
    return {first, given.count, given.stride == 0 ? 3 * sizeof(Number) : given.stride};
}
template <class Number>
StridedPositions strided(const Number* const (&axes)[3], const char* member, const meniscus_particles& given) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (axes[axis] == nullptr)
            throw InvalidInput("particles->" + std::string(member) + "[" + std::to_string(axis) +
                               "] is NULL, must point to the " + "xyz"[axis] + " of " + std::to_string(given.count) +
                               " particles");
    return {std::array{axes[0], axes[1], axes[2]}, given.count, given.stride == 0 ? sizeof(Number) : given.stride};
}

StridedPositions positions_of(const meniscus_particles& given) {
    if (given.count == 0) return {std::span<const float>()};
    if (given.positions_double != nullptr) return strided(given.positions_double, given);
    if (has_axes(given.axes)) return strided(given.axes, "axes", given);
    if (has_axes(given.axes_double)) return strided(given.axes_double, "axes_double", given);
    return strided(given.positions, given);
}

std::span<const std::uint8_t> levels_of(const meniscus_particles& given) {
    if (given.levels == nullptr) return {};
    return {given.levels, given.count};
}

std::optional<ElementType> type_of(std::uint32_t type) {
    switch (type) {
        case MENISCUS_FLOAT32:
            return ElementType::float32;
        case MENISCUS_UINT8:
            return ElementType::uint8;
        case MENISCUS_INT32:
            return ElementType::int32;
        case MENISCUS_UINT32:
            return ElementType::uint32;
        default:
            return std::nullopt;
    }
}

ParticleArray array_of(const meniscus_array& array, std::size_t place, std::size_t particles) {
    const std::string what = "particles->arrays[" + std::to_string(place) + "]";
    if (array.name == nullptr) throw InvalidInput(what + ".name is NULL, must be the array's name");
    constexpr std::size_t longest = 64;
    const std::string_view name(array.name, strnlen(array.name, longest + 1));
    if (name.empty() || name.size() > longest)
        throw InvalidInput(what + ".name has " + (name.empty() ? "no" : "more than " + std::to_string(longest)) +
                           " characters, must have 1 to " + std::to_string(longest));
    const std::optional<ElementType> type = type_of(array.type);
    if (!type)
        throw InvalidInput(what + ".type is " + std::to_string(array.type) +
                           ", must be MENISCUS_FLOAT32, MENISCUS_UINT8, MENISCUS_INT32 or MENISCUS_UINT32");
    constexpr std::uint32_t most_components = 16;
    if (array.components < 1 || array.components > most_components)
        throw InvalidInput(what + ".components are " + std::to_string(array.components) + ", must be 1 to " +
                           std::to_string(most_components));
    if (array.data == nullptr && particles != 0)
        throw InvalidInput(what + ".data is NULL, must point to the numbers of " + std::to_string(particles) +
                           " particles");
    return {.name = name,
            .data = {static_cast<const std::byte*>(array.data), size_of(*type) * array.components * particles},
            .type = *type,
            .components = array.components};
}

void read_arrays(const meniscus_particles& given, std::vector<ParticleArray>& arrays) {
    arrays.clear();
    if (given.array_count > max_particle_arrays)
        throw LimitExceeded("particles->array_count is " + std::to_string(given.array_count) + ", must be at most " +
                            std::to_string(max_particle_arrays));
    if (given.array_count != 0 && given.arrays == nullptr)
        throw InvalidInput("particles->arrays is NULL, must point to " + std::to_string(given.array_count) + " arrays");
    for (std::size_t i = 0; i < given.array_count; ++i) arrays.push_back(array_of(given.arrays[i], i, given.count));
}

}  // namespace

GivenParticles read_particles(const meniscus_particles* particles) {
    const meniscus_particles given = checked(particles);
    GivenParticles read{positions_of(given), levels_of(given), {}};
    read_arrays(given, read.arrays);
    return read;
}

HandedFrame read_frame(const meniscus_particles* particles, FrameBuffers& buffers) {
    const meniscus_particles given = checked(particles);
    ParticleFrame frame;
    frame.levels = levels_of(given);
    const bool stay = given.positions == nullptr || (given.stride != 0 && given.stride != 3 * sizeof(float));
    if (!stay) {
        frame.positions = {given.positions, 3 * given.count};
    } else {
        buffers.positions.resize(3 * given.count);
        positions_of(given).copy_to(buffers.positions);
        frame.positions = buffers.positions;
    }
    read_arrays(given, buffers.arrays);
    frame.arrays = buffers.arrays;
    return {frame, stay};
}

}  // namespace meniscus::c
