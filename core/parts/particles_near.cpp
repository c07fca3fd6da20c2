#include "parts/particles_near.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "particles/positions.hpp"
#include "parts/message.hpp"
#include "parts/packed_positions.hpp"

namespace meniscus {
namespace {

/// Particles of a group.
constexpr std::size_t group_size = 256;

/// Numbers that are looked at together, for the compiler to do so with vectors: of eight particles.
constexpr std::size_t lanes = 24;
static_assert(lanes % 3 == 0 && 3 * group_size % lanes == 0);

/// Of at least one position, x y z each.
template <class Number>
NumberBounds bounds_of(std::span<const Number> numbers) {
    std::array<Number, lanes> least, greatest;
    for (std::size_t lane = 0; lane < lanes; ++lane) least[lane] = greatest[lane] = numbers[lane % 3];
    const auto take = [&](std::size_t lane, Number number) {
        least[lane] = number < least[lane] ? number : least[lane];
        greatest[lane] = number > greatest[lane] ? number : greatest[lane];
    };
    std::size_t i = 0;
    for (; i + lanes <= numbers.size(); i += lanes)
        for (std::size_t lane = 0; lane < lanes; ++lane) take(lane, numbers[i + lane]);
    for (std::size_t lane = 0; i < numbers.size(); ++i, ++lane) take(lane, numbers[i]);
    NumberBounds bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Number low = least[axis], high = greatest[axis];
        for (std::size_t lane = axis + 3; lane < lanes; lane += 3) {
            low = std::min(low, least[lane]);
            high = std::max(high, greatest[lane]);
        }
        bounds.least[axis] = low;
        bounds.greatest[axis] = high;
    }
    return bounds;
}

/// Calls act(numbers, first particle) for each group.
template <class Number, class Act>
void for_each_group(std::span<const Number> numbers, const Act& act) {
    constexpr std::size_t step = 3 * group_size;
    for (std::size_t first = 0; first < numbers.size(); first += step)
        act(numbers.subspan(first, std::min(step, numbers.size() - first)), first / 3);
}
template <class Act>
void for_each_group(const ParticleFrame& frame, const Act& act) {
    if (frame.is_quantized())
        for_each_group(frame.quantized, act);
    else
        for_each_group(frame.positions, act);
}

bool are_apart(const NumberBounds& a, const NumberBounds& b) {
    bool are_apart = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        are_apart = are_apart || a.greatest[axis] < b.least[axis] || a.least[axis] > b.greatest[axis];
    return are_apart;
}

bool is_within(const NumberBounds& inner, const NumberBounds& outer) {
    bool is_within = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
        is_within = is_within && inner.least[axis] >= outer.least[axis] && inner.greatest[axis] <= outer.greatest[axis];
    return is_within;
}

/// Writes the places of those of a group that are within the box; returns the number of them. places: has room for all.
template <class Number>
std::size_t choose(std::span<const Number> numbers, std::size_t first_particle, const NumberBounds& box,
                   std::uint32_t* places) {
    std::array<float, lanes> least, greatest;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        least[lane] = box.least[lane % 3];
        greatest[lane] = box.greatest[lane % 3];
    }
    std::array<std::uint32_t, 3 * group_size> are_within;
    const auto test = [&](std::size_t i, std::size_t lane) {
        const auto x = static_cast<float>(numbers[i]);
        are_within[i] = static_cast<std::uint32_t>((x >= least[lane]) & (x <= greatest[lane]));
    };
    std::size_t i = 0;
    for (; i + lanes <= numbers.size(); i += lanes)
        for (std::size_t lane = 0; lane < lanes; ++lane) test(i + lane, lane);
    for (std::size_t lane = 0; i < numbers.size(); ++i, ++lane) test(i, lane);
    std::size_t count = 0;
    for (std::size_t p = 0; p < numbers.size() / 3; ++p) {
        places[count] = static_cast<std::uint32_t>(first_particle + p);
        count += are_within[3 * p] & are_within[3 * p + 1] & are_within[3 * p + 2];
    }
    return count;
}

/// The first of all 16-bit numbers from which on it holds; 65536 where it holds of none.
template <class Holds>
float first_number(const Holds& holds) {
    int first = 0, end = 65536;
    while (first < end) {
        const int middle = first + (end - first) / 2;
        if (holds(middle))
            end = middle;
        else
            first = middle + 1;
    }
    return static_cast<float>(first);
}

}  // namespace

void ParticlesNear::begin(const ParticleFrame& frame, const Settings& settings) {
    frame_ = frame;
    units_per_length_ = units_per_length(settings);
    groups_.clear();
    for_each_group(frame, [this](auto numbers, std::size_t) { groups_.push_back(bounds_of(numbers)); });
    if (groups_.empty()) return;
    all_ = groups_[0];
    for (const NumberBounds& group : groups_)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            all_.least[axis] = std::min(all_.least[axis], group.least[axis]);
            all_.greatest[axis] = std::max(all_.greatest[axis], group.greatest[axis]);
        }
}

NumberBounds ParticlesNear::numbers_within(const Box& box) const {
    NumberBounds numbers;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float& least = numbers.least[axis];
        float& greatest = numbers.greatest[axis];
        if (frame_.is_quantized()) {
            const Box& ends = frame_.quantization_box;
            const auto coordinate = [&](int number) {
                return decoded(static_cast<std::uint16_t>(number), ends.min[axis], ends.max[axis]);
            };
            least = first_number([&](int n) { return coordinate(n) >= box.min[axis]; });
            greatest = first_number([&](int n) { return coordinate(n) > box.max[axis]; }) - 1.0F;
        } else {
            constexpr float infinity = std::numeric_limits<float>::infinity();
            constexpr double most = std::numeric_limits<float>::max();
            const double low = std::clamp(box.min[axis], -most, most), high = std::clamp(box.max[axis], -most, most);
            least = static_cast<float>(low);
            if (double{least} < low) least = std::nextafter(least, infinity);
            greatest = static_cast<float>(high);
            if (double{greatest} > high) greatest = std::nextafter(greatest, -infinity);
        }
    }
    return numbers;
}

std::span<const std::uint32_t> ParticlesNear::places_within(const NumberBounds& box) {
    places_.resize(frame_.count());
    std::size_t count = 0, group = 0;
    for_each_group(frame_, [&](auto numbers, std::size_t first) {
        const NumberBounds& bounds = groups_[group++];
        if (are_apart(bounds, box)) return;
        if (is_within(bounds, box)) {
            const auto begin = places_.begin() + static_cast<std::ptrdiff_t>(count);
            const std::size_t particles = numbers.size() / 3;
            std::iota(begin, begin + static_cast<std::ptrdiff_t>(particles), static_cast<std::uint32_t>(first));
            count += particles;
        } else {
            count += choose(numbers, first, box, places_.data() + count);
        }
    });
    return std::span(places_).first(count);
}

std::vector<std::byte> ParticlesNear::within(const Box& box, std::vector<std::byte> memory) {
    MessageWriter message(std::move(memory));
    const NumberBounds numbers = numbers_within(box);
    if (groups_.empty() || are_apart(all_, numbers)) return message.take();
    const bool are_all_in = is_within(all_, numbers);
    const std::span<const std::uint32_t> chosen =
        are_all_in ? std::span<const std::uint32_t>() : places_within(numbers);
    const std::size_t count = are_all_in ? frame_.count() : chosen.size();
    if (count == 0) return message.take();
    // With the counts of the arrays, and the byte that Agreement adds.
    std::size_t bytes = (frame_.arrays.size() + 4) * sizeof(std::uint64_t) + 1;
    const auto each = [](const auto& values) { return values.empty() ? 0 : sizeof values[0]; };
    bytes += count * ((frame_.positions.empty() ? 0 : packed_position_bytes) + 3 * each(frame_.quantized) +
                      each(frame_.levels));
    for (const ParticleArray& array : frame_.arrays) bytes += count * array.element_bytes();
    message.reserve(bytes);
    const auto add = [&](const auto& values, std::size_t of_each) {
        if (are_all_in || values.empty())
            message.add_all(values);
        else
            message.add_some(values, of_each, chosen);
    };
    add_positions(message, frame_.positions, chosen, units_per_length_);
    add(frame_.quantized, 3);
    add(frame_.levels, 1);
    for (const ParticleArray& array : frame_.arrays) add(array.data, array.element_bytes());
    return message.take();
}

}  // namespace meniscus
