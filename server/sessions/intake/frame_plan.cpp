#include "sessions/intake/frame_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"
#include "sessions/limits/limit_reached.hpp"

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

constexpr std::uint64_t countable = std::numeric_limits<std::ptrdiff_t>::max();

std::size_t rounded_up(std::size_t offset, std::size_t multiple) {
    return (offset + multiple - 1) / multiple * multiple;
}

/// The most bytes per particle that such a frame takes here.
std::uint64_t kept_bytes_per_particle(const FramePart& part) {
    std::uint64_t bytes = part.layout.position_bytes + (part.layout.has_levels ? 1 : 0);
    for (const FurtherArray& array : part.kept) bytes += array.bytes;
    return bytes;
}

const FurtherArray* find_array(const std::vector<FurtherArray>& arrays, const std::string& name) {
    const auto found = std::ranges::find(arrays, name, &FurtherArray::name);
    return found != arrays.end() ? &*found : nullptr;
}

std::string words_of(const FurtherArray* array) {
    return array != nullptr ? conversion::form_of(*array) : "missing";
}

/// Equal texts for equal numbers, which -0 and 0 are.
std::string words_of(double number) {
    return fmt::format("{}", number + 0.0);
}

std::string words_of(const Box& box) {
    const auto corner = [](const auto& at) {
        return fmt::format("({}, {}, {})", words_of(at[0]), words_of(at[1]), words_of(at[2]));
    };
    return corner(box.min) + " to " + corner(box.max);
}

/// Throws InvalidInput where a part says something else of its frame than the lead, whose form the frame takes.
class SameInAllParts {
public:
    SameInAllParts(std::span<const FramePart> parts, const FramePart& lead, const FramePart& part)
        : parts_(parts), lead_(lead), part_(part) {}

    void require(const std::string& what, const std::string& is, const std::string& of_lead) const {
        if (is != of_lead)
            throw InvalidInput(
                fmt::format("frame {}: {} of part {} is {}, and {} in part {}; in all parts of a frame it is the same",
                            part_.index, what, &part_ - parts_.data(), is, of_lead, &lead_ - parts_.data()));
    }
    void require_time() const {
        require("simulation_time", words_of(part_.simulation_time), words_of(lead_.simulation_time));
    }

private:
    const std::span<const FramePart> parts_;
    const FramePart& lead_;
    const FramePart& part_;
};

/// Throws InvalidInput if the part cannot be in one frame with the lead.
void require_same_form(std::span<const FramePart> parts, const FramePart& lead, const FramePart& part) {
    const SameInAllParts same(parts, lead, part);
    same.require_time();
    // A part without particles has no form.
    if (part.particle_count == 0) return;
    const auto positions = [](const FramePart& of) { return of.layout.quantized ? "uint16" : "float32"; };
    same.require("array 'position'", positions(part), positions(lead));
    if (part.layout.quantized)
        same.require("quantization_box", words_of(part.quantization_box), words_of(lead.quantization_box));
    const auto levels = [](const FramePart& of) { return of.layout.has_levels ? "there" : "missing"; };
    same.require("array 'level'", levels(part), levels(lead));
    for (const auto* arrays : {&part.kept, &lead.kept})
        for (const FurtherArray& array : *arrays)
            same.require(fmt::format("array '{}'", array.name), words_of(find_array(part.kept, array.name)),
                         words_of(find_array(lead.kept, array.name)));
}

/// Throws LimitExceeded for a frame of more bytes than may be in flight, or held.
void allocate(std::size_t bytes, std::uint64_t index, InputFrame& frame) {
    try {
        frame.allocate(bytes);
    } catch (const LimitReached& error) {
        throw LimitReached(error.limit(), fmt::format("frame {}: {}", index, error.what()));
    } catch (const LimitExceeded& error) {
        throw LimitExceeded(fmt::format("frame {}: {}", index, error.what()));
    }
}

/// begin_frame() of finished bricks.
std::vector<std::vector<FramePiece>> begin_brick_frame(std::span<const FramePart> parts, const Limits& limits,
                                                       InputFrame& frame) {
    const FramePart& lead = parts.front();
    const std::uint64_t limit = limits.bytes_per_session != 0 ? limits.bytes_per_session : countable;
    std::vector<BrickPart> bricks;
    std::vector<std::vector<FramePiece>> pieces;
    std::size_t bytes = 0;
    for (const FramePart& part : parts) {
        SameInAllParts(parts, lead, part).require_time();
        bricks.push_back(*part.bricks);
        const std::size_t more = bricks.back().bytes;
        if (more > limit - bytes)
            throw LimitExceeded(
                fmt::format("frame {}: bricks of more than {} bytes; the server holds at most {} bytes per "
                            "session",
                            lead.index, limit, limit));
        auto& of_part = pieces.emplace_back();
        if (more != 0) of_part.push_back({.begin = 0, .end = more, .kept = true, .place = bytes});
        bytes += more;
    }
    try {
        require_same_surface(bricks);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", lead.index, error.what()));
    }
    allocate(bytes, lead.index, frame);
    frame.index = lead.index;
    frame.simulation_time = lead.simulation_time;
    frame.particle_count = 0;
    frame.brick_parts = std::move(bricks);
    return pieces;
}

/// The particles of all parts. Throws LimitExceeded for too many.
std::size_t particles_of(std::span<const FramePart> parts, const FramePart& lead, const Limits& limits) {
    std::uint64_t count = 0;
    for (const FramePart& part : parts)
        count += std::min(part.particle_count, std::numeric_limits<std::uint64_t>::max() - count);
    if (limits.particles_per_frame != 0 && count > limits.particles_per_frame)
        throw LimitExceeded(fmt::format("frame {}: {} particles; the server takes at most {} per frame", lead.index,
                                        count, limits.particles_per_frame));
    const std::uint64_t limit = limits.bytes_per_session != 0 ? limits.bytes_per_session : countable;
    const std::uint64_t particle_bytes = kept_bytes_per_particle(lead);
    if (count > limit / particle_bytes)
        throw LimitExceeded(
            fmt::format("frame {}: {} particles of {} bytes; the server holds at most {} bytes per session", lead.index,
                        count, particle_bytes, limit));
    std::uint64_t arriving = 0;
    for (const FramePart& part : parts) {
        arriving += arriving_bytes(part);
        if (arriving > countable)
            throw LimitExceeded(
                fmt::format("frame {}: {} particles; the server takes at most {} bytes", lead.index, count, countable));
    }
    return static_cast<std::size_t>(count);
}

/// Where the arrays of a frame lie in InputFrame::bytes; positions lie at the beginning.
struct Places {
    std::size_t levels = 0;
    std::vector<InputFrame::KeptArray> arrays;
    std::size_t bytes = 0;
};

/// count: of particles, small enough that all of the frame's bytes can be counted.
Places places_of(const FramePart& lead, std::size_t count) {
    Places places;
    places.levels = count * lead.layout.position_bytes;
    places.bytes = places.levels + (lead.layout.has_levels ? count : 0);
    for (const FurtherArray& array : lead.kept) {
        // So that its numbers can be read where they lie.
        if (count != 0) places.bytes = rounded_up(places.bytes, size_of(*array.type));
        places.arrays.push_back(
            {.name = array.name, .type = *array.type, .components = array.components, .offset = places.bytes});
        places.bytes += count * array.bytes;
    }
    return places;
}

/// first: the number of the part's first particle in the frame.
std::vector<FramePiece> pieces_of(const FramePart& part, std::size_t first, const Places& places) {
    if (part.particle_count == 0) return {};
    const auto count = static_cast<std::size_t>(part.particle_count);
    std::vector<FramePiece> pieces;
    const auto add = [&](std::uint64_t after, std::uint64_t bytes, bool kept, std::size_t place) {
        pieces.push_back({.begin = count * after,
                          .end = count * (after + bytes),
                          .kept = kept,
                          .place = kept ? place + first * bytes : 0});
    };
    add(0, part.layout.position_bytes, true, 0);
    if (part.layout.has_levels) add(part.layout.levels_after, 1, true, places.levels);
    for (const FurtherArray& array : part.layout.further) {
        const auto found = std::ranges::find(places.arrays, array.name, &InputFrame::KeptArray::name);
        const bool kept = found != places.arrays.end();
        add(array.after, array.bytes, kept, kept ? found->offset : 0);
    }
    std::ranges::sort(pieces, {}, &FramePiece::begin);
    return pieces;
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

std::size_t arriving_bytes(const FramePart& part) {
    if (part.bricks) return part.bricks->bytes;
    if (part.particle_count > countable / part.layout.particle_bytes)
        throw LimitExceeded(fmt::format("frame {}: {} particles of {} bytes; the server takes at most {} bytes",
                                        part.index, part.particle_count, part.layout.particle_bytes, countable));
    return static_cast<std::size_t>(part.particle_count * part.layout.particle_bytes);
}

std::vector<std::vector<FramePiece>> begin_frame(std::span<const FramePart> parts, const Limits& limits,
                                                 InputFrame& frame) {
    if (parts.front().bricks) return begin_brick_frame(parts, limits, frame);
    const auto with_particles = std::ranges::find_if(parts, [](const auto& part) { return part.particle_count != 0; });
    const FramePart& lead = with_particles != parts.end() ? *with_particles : parts.front();
    for (const FramePart& part : parts) require_same_form(parts, lead, part);
    const std::size_t count = particles_of(parts, lead, limits);
    Places places = places_of(lead, count);
    allocate(places.bytes, lead.index, frame);
    frame.index = lead.index;
    frame.simulation_time = lead.simulation_time;
    frame.particle_count = count;
    frame.quantized = lead.layout.quantized;
    frame.quantization_box = lead.quantization_box;
    frame.has_levels = lead.layout.has_levels;
    std::vector<std::vector<FramePiece>> pieces;
    std::size_t first = 0;
    for (const FramePart& part : parts) {
        pieces.push_back(pieces_of(part, first, places));
        first += static_cast<std::size_t>(part.particle_count);
    }
    frame.keep_arrays(std::move(places.arrays));
    return pieces;
}

}  // namespace meniscus::server
