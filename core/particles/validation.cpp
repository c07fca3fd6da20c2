// Checks of what comes from outside, once, at the edge.
#include "particles/validation.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lattice/coordinates.hpp"
#include "meniscus/error.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/reconstructor.hpp"
#include "meniscus/settings.hpp"
#include "particles/attribute_choice.hpp"

namespace meniscus {
namespace {

template <std::integral Number>
std::string text(Number value) {
    return std::to_string(value);
}

std::string text(double value) {
    std::ostringstream out;
    out.precision(9);
    out << value;
    return out.str();
}

/// subject: such as "cell size is".
template <class Number>
void require_positive(std::string_view subject, Number number, const Range& range) {
    if (std::is_floating_point_v<Number> && range.least > 0.0 &&
        !(std::isfinite(static_cast<double>(number)) && number > 0))
        throw InvalidInput(std::string(subject) + " " + text(number) + ", must be finite and greater than 0");
}

template <class Number>
void require_within(std::string_view subject, Number number, const Range& range) {
    const auto value = static_cast<double>(number);
    if (std::isfinite(value) && value >= range.least && value <= range.most) return;
    std::string limits = text(range.least) + " to " + text(range.most);
    if (std::isinf(range.most)) limits = std::isinf(range.least) ? "finite" : "at least " + text(range.least);
    if (range.least == above_zero) limits = "at most " + text(range.most);
    throw InvalidInput(std::string(subject) + " " + text(number) + ", must be " + limits +
                       (range.advice.empty() ? "" : ": " + std::string(range.advice)));
}

/// Calls visit(subject, number, range) for each number of the settings: for those that are always there, or for the
/// others, which may be missing.
template <bool always_there, class Visit>
void for_each_number(const Settings& settings, const Visit& visit) {
    for_each_row<Settings>([&]<class Row>(const Row& row) {
        using Number = Held<typename Row::Type>;
        constexpr bool is_there = std::is_same_v<Row, meniscus::Row<Settings, Number>>;
        if constexpr (std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool> && is_there == always_there) {
            const auto* const value = row.find(settings);
            if (value == nullptr) return;
            const std::optional<Number> number = *value;
            const std::string subject(row.facts.subject.empty() ? words_of(row.name) + " is" : row.facts.subject);
            if (number) visit(subject, *number, row.facts.range);
        }
    });
}

/// Refuses a number outside of the range in its row.
void require_ranges(const Settings& settings) {
    for_each_number<true>(settings, [](const auto& subject, auto number, const Range& range) {
        require_positive(subject, number, range);
    });
    constexpr const char* world = "cell size in world units is";
    constexpr Range world_lengths{1e-60, 1e60, "take another unit of length"};
    require_positive(world, world_cell_size(settings), world_lengths);
    for_each_number<true>(
        settings, [](const auto& subject, auto number, const Range& range) { require_within(subject, number, range); });
    require_within(world, world_cell_size(settings), world_lengths);
}

/// The same for those of one field, criterion or way of finding edge points.
void require_chosen_ranges(const Settings& settings) {
    for_each_number<false>(settings, [](const auto& subject, auto number, const Range& range) {
        require_positive(subject, number, range);
        require_within(subject, number, range);
    });
}

void require_box(const char* name, const Box& box, bool may_be_flat) {
    for (std::size_t i = 0; i < 3; ++i) {
        const bool ordered = may_be_flat ? box.min[i] <= box.max[i] : box.min[i] < box.max[i];
        if (!std::isfinite(box.min[i]) || !std::isfinite(box.max[i]) || !ordered)
            throw InvalidInput(std::string(name) + " runs from " + text(box.min[i]) + " to " + text(box.max[i]) +
                               " along " + std::string(axes[i]) + ", must be finite and run upward");
    }
}

/// What belongs to one field is refused with another, where it would change nothing.
void require_field_settings(const Settings& s) {
    if (s.field == Field::smooth) {
        // In float32, as the field is.
        if (static_cast<float>(s.iso) >= 1.0F)
            throw InvalidInput(
                "iso value is " + text(s.iso) +
                ", must be less than 1 with the field smooth, which is about 1 inside a fluid and 1 at a "
                "particle alone: 0.4 to 0.7 are usual");
        if (s.smoothing_length)
            throw InvalidInput("the smoothing length is " + text(*s.smoothing_length) +
                               ", but the field is smooth, which has none: leave it out and use --smoothness, or take "
                               "--field color");
        return;
    }
    const std::string field(name_of(s.field));
    if (s.smoothness)
        throw InvalidInput("the smoothness is " + std::to_string(*s.smoothness) + ", but the field is " + field +
                           ", which has none: leave it out and use --smoothing-length, or take --field smooth");
    if (s.spray != Spray::keep)
        throw InvalidInput("spray is " + std::string(name_of(s.spray)) + ", but the field is " + field +
                           ", which does not tell spray from water: take --spray keep or --field smooth");
}

/// Radii, with Field::smooth: beyond it the supports of particles alone are too few units of c/4096.
constexpr double max_smooth_cell_size = 1024.0;

/// The coarsest particle level's support must stay exact in float32.
void require_support(const Settings& s, unsigned coarsest_level) {
    const double cells = std::ldexp(support(s) / s.cell_size, static_cast<int>(coarsest_level));
    if (cells > max_support_cells)
        throw InvalidInput("the support of particle level " + std::to_string(coarsest_level) + " spans " + text(cells) +
                           " cells, at most " + std::to_string(max_support_cells) +
                           " are possible: use a larger cell size");
}

}  // namespace

void validate(const Settings& s) {
    require_ranges(s);
    // In float32 the iso value must remain above zero, or the outside would be inside.
    if (static_cast<float>(s.iso) == 0.0F)
        throw InvalidInput("iso value is " + text(s.iso) + ", must be greater than 0 as a float32, too");
    require_field_settings(s);
    require_chosen_ranges(s);
    if (s.field == Field::smooth && s.cell_size > max_smooth_cell_size)
        throw InvalidInput("the cell size is " + text(s.cell_size) + " radii, must be at most " +
                           text(max_smooth_cell_size) + " with --field smooth: is the particle radius right?");
    require_support(s, 0);
    if (s.domain) require_box("domain", *s.domain, false);
    validate_attribute_names(s);
}

void validate_lengths(const ParticleFrame& frame) {
    if (!frame.positions.empty() && !frame.quantized.empty())
        throw InvalidInput("the frame has both float and quantized positions, must have one of them");
    const std::size_t numbers = frame.is_quantized() ? frame.quantized.size() : frame.positions.size();
    if (numbers % 3 != 0)
        throw InvalidInput("the frame has " + std::to_string(numbers) + " coordinates, must be three per particle");
    const std::size_t count = frame.count();
    if (count >= 0xFFFFFFFFULL)
        throw LimitExceeded("the frame has " + std::to_string(count) +
                            " particles, at most 4294967294 can be numbered: split it");
    if (!frame.levels.empty() && frame.levels.size() != count)
        throw InvalidInput("the frame has " + std::to_string(frame.levels.size()) + " levels for " +
                           std::to_string(count) + " particles, must have one each or none");
    if (frame.arrays.size() > max_particle_arrays)
        throw LimitExceeded("the frame has " + std::to_string(frame.arrays.size()) + " arrays, at most " +
                            std::to_string(max_particle_arrays) + " are possible: leave some out");
    for (const ParticleArray& array : frame.arrays) {
        if (array.element_bytes() < 1)
            throw InvalidInput("array '" + std::string(array.name) + "' has 0 components, must have at least 1");
        if (array.data.size() / array.element_bytes() != count || array.data.size() % array.element_bytes() != 0)
            throw InvalidInput("array '" + std::string(array.name) + "' has " + std::to_string(array.data.size()) +
                               " bytes, must have " + std::to_string(array.element_bytes()) + " for each of " +
                               std::to_string(count) + " particles");
    }
}

double farthest_coordinate(const Settings& settings) {
    return static_cast<double>(max_cell) * world_cell_size(settings);
}

void require_level(const Settings& settings, std::uint64_t particle, unsigned level) {
    if (level > max_particle_level)
        throw InvalidInput("particle " + std::to_string(particle) + " has level " + std::to_string(level) +
                           ", must be 0 to " + std::to_string(max_particle_level));
    require_support(settings, level);
}

void refuse_coordinate(const Settings& settings, std::uint64_t coordinate, float value) {
    const double p = static_cast<double>(value);
    const std::string where =
        "particle " + std::to_string(coordinate / 3) + " has " + "xyz"[coordinate % 3] + " = " + text(p);
    if (!std::isfinite(p)) throw InvalidInput(where + ", positions must be finite");
    throw InvalidInput(where + ", farther from the origin than the " + text(farthest_coordinate(settings)) +
                       " that this cell size can address");
}

void validate(const ParticleFrame& frame, const Settings& settings) {
    validate_lengths(frame);
    const std::vector<ParticleArray> attributes = AttributeChoice(settings).of(frame);
    validate_places(frame, settings);
    numbers_in_host_memory(attributes);
}

void validate_places(const ParticleFrame& frame, const Settings& settings) {
    if (!frame.levels.empty()) {
        const auto coarsest = std::max_element(frame.levels.begin(), frame.levels.end());
        require_level(settings, static_cast<std::uint64_t>(coarsest - frame.levels.begin()), *coarsest);
    }
    const double limit = farthest_coordinate(settings);
    if (frame.is_quantized()) {
        const Box& box = frame.quantization_box;
        require_box("quantization box", box, true);
        for (std::size_t i = 0; i < 3; ++i)
            if (std::max(std::abs(box.min[i]), std::abs(box.max[i])) > limit)
                throw InvalidInput("the quantization box reaches from " + text(box.min[i]) + " to " + text(box.max[i]) +
                                   ", farther from the origin than the " + text(limit) +
                                   " that this cell size can address");
        return;
    }
    // As a float32: the greatest that is no farther.
    auto farthest = static_cast<float>(limit);
    if (static_cast<double>(farthest) > limit) farthest = std::nextafter(farthest, 0.0F);
    // Also false for a NaN.
    const auto is_within = [farthest](float x) { return std::abs(x) <= farthest; };
    // All of some at a time, without a branch.
    constexpr std::size_t at_once = 1024;
    for (std::size_t first = 0; first < frame.positions.size(); first += at_once) {
        const auto some = frame.positions.subspan(first, std::min(at_once, frame.positions.size() - first));
        unsigned are_within = 1;
        for (const float x : some) are_within &= static_cast<unsigned>(is_within(x));
        if (are_within != 0) continue;
        const auto wrong = std::find_if_not(some.begin(), some.end(), is_within);
        refuse_coordinate(settings, first + static_cast<std::size_t>(wrong - some.begin()), *wrong);
    }
}

}  // namespace meniscus
