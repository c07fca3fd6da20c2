#include "sessions/intake/frame_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

using conversion::FurtherArray;

/// The names of the arrays, for the refusal of a frame that lacks one.
std::string names_of(const std::vector<FurtherArray>& arrays) {
    if (arrays.empty()) return "none beside positions and levels";
    std::string names;
    for (const FurtherArray& array : arrays) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", array.name);
    return names;
}

std::size_t rounded_up(std::size_t offset, std::size_t multiple) {
    return (offset + multiple - 1) / multiple * multiple;
}

}  // namespace

std::vector<FurtherArray> arrays_to_keep(const conversion::ParticleLayout& layout, std::uint64_t particle_count,
                                         const Settings& settings) {
    std::vector<FurtherArray> arrays;
    if (settings.all_attributes)
        std::ranges::copy_if(layout.further, std::back_inserter(arrays), &FurtherArray::can_be_attribute);
    for (const std::string& name : settings.attributes) {
        const auto found = std::ranges::find(layout.further, name, &FurtherArray::name);
        if (found == layout.further.end() && particle_count == 0) continue;
        if (found == layout.further.end())
            throw InvalidInput(fmt::format(
                "no array '{}', which the session's settings name as an attribute; the frame's further arrays are {}",
                name, names_of(layout.further)));
        if (!found->can_be_attribute())
            throw InvalidInput(
                fmt::format("array '{}' is {}, and the session's settings name it as an attribute; that is {}", name,
                            conversion::form_of(*found), attribute_forms));
        arrays.push_back(*found);
    }
    std::ranges::sort(arrays, {}, &FurtherArray::after);
    return arrays;
}

std::uint64_t kept_bytes_per_particle(const conversion::ParticleLayout& layout, const std::vector<FurtherArray>& kept) {
    std::uint64_t bytes = layout.position_bytes + (layout.has_levels ? 1 : 0);
    for (const FurtherArray& array : kept) bytes += array.bytes;
    return bytes;
}

FramePlan plan_frame(const conversion::ParticleLayout& layout, const std::vector<FurtherArray>& kept,
                     std::size_t count) {
    FramePlan plan;
    const auto keep = [&](std::uint64_t after, std::uint64_t bytes) {
        plan.pieces.push_back(
            {.begin = count * after, .end = count * (after + bytes), .kept = true, .place = plan.bytes});
        plan.bytes += count * bytes;
    };
    keep(0, layout.position_bytes);
    if (layout.has_levels) keep(layout.levels_after, 1);
    for (const FurtherArray& array : layout.further) {
        if (std::ranges::find(kept, array.name, &FurtherArray::name) == kept.end()) {
            plan.pieces.push_back({.begin = count * array.after, .end = count * (array.after + array.bytes)});
            continue;
        }
        // So that its numbers can be read where they lie.
        if (count != 0) plan.bytes = rounded_up(plan.bytes, size_of(*array.type));
        plan.arrays.push_back(
            {.name = array.name, .type = *array.type, .components = array.components, .offset = plan.bytes});
        keep(array.after, array.bytes);
    }
    std::erase_if(plan.pieces, [](const FramePlan::Piece& piece) { return piece.begin == piece.end; });
    std::ranges::sort(plan.pieces, {}, &FramePlan::Piece::begin);
    return plan;
}

}  // namespace meniscus::server
