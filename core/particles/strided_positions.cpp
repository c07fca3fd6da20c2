#include "meniscus/strided_positions.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {
namespace {

/// False for a NaN, and for what a float64 beyond float32's range becomes, which is an infinity.
bool is_position(float value) {
    return std::abs(value) <= std::numeric_limits<float>::max();
}

std::size_t particles_in(std::size_t numbers) {
    if (numbers % 3 != 0)
        throw InvalidInput("the frame has " + std::to_string(numbers) + " coordinates, must be three per particle");
    return numbers / 3;
}

/// least: numbers that lie next to each other.
void check(bool has_memory, std::size_t count, std::size_t stride, std::size_t number, std::size_t least) {
    if (!has_memory && count != 0)
        throw InvalidInput("the frame has " + std::to_string(count) + " particles, but no memory with their positions");
    if (stride < least * number)
        throw InvalidInput("the stride is " + std::to_string(stride) + " bytes, must be at least " +
                           std::to_string(least * number) + ": " + (least == 1 ? "one number" : "three numbers") +
                           " of " + std::to_string(number) + " bytes");
    if (count > std::numeric_limits<std::size_t>::max() / stride)
        throw InvalidInput(std::to_string(count) + " particles with a stride of " + std::to_string(stride) +
                           " bytes are more than memory can hold");
}

using Places = std::array<const std::byte*, 3>;

/// Of x y z that lie next to each other.
template <class Number>
Places places_from(const Number* first) {
    const auto* const x = reinterpret_cast<const std::byte*>(first);
    if (x == nullptr) return {};
    return {x, x + sizeof(Number), x + 2 * sizeof(Number)};
}
template <class Number>
Places places_of(const std::array<const Number*, 3>& first) {
    Places places;
    for (std::size_t axis = 0; axis < 3; ++axis) places[axis] = reinterpret_cast<const std::byte*>(first[axis]);
    return places;
}

bool all_set(const Places& places) {
    return places[0] != nullptr && places[1] != nullptr && places[2] != nullptr;
}

template <class Number>
Number number_at(const std::byte* place) {
    Number number;
    std::memcpy(&number, place, sizeof number);
    return number;
}

[[noreturn]] void refuse(std::size_t particle, std::size_t axis, double value) {
    std::ostringstream what;
    what.precision(9);
    what << "particle " << particle << " has "
         << "xyz"[axis] << " = " << value;
    if (std::isfinite(value))
        what << ", which float32 cannot hold: at most " << std::numeric_limits<float>::max()
             << "; take another unit of length";
    else
        what << ", positions must be finite";
    throw InvalidInput(what.str());
}

/// Converts numbers that lie next to each other. Returns whether float32 holds all of them. Without a branch, for
/// vectors of them.
template <class Number, std::size_t count>
bool copy_row(const std::byte* row, std::span<float, count> out) {
    unsigned misfits = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<float>(number_at<Number>(row + i * sizeof(Number)));
        misfits |= static_cast<unsigned>(!is_position(out[i]));
    }
    return misfits == 0;
}

/// Likewise x y z that lie apart.
template <class Number>
bool copy_axes(const Places& first, std::size_t stride, std::span<float> out) {
    unsigned misfits = 0;
    for (std::size_t i = 0; i < out.size() / 3; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<float>(number_at<Number>(first[axis] + i * stride));
            out[3 * i + axis] = value;
            misfits |= static_cast<unsigned>(!is_position(value));
        }
    return misfits == 0;
}

template <class Number>
void copy_numbers(const Places& first, std::size_t stride, std::span<float> positions) {
    bool all_fit = true;
    if (first != places_from(reinterpret_cast<const Number*>(first[0])))
        all_fit = copy_axes<Number>(first, stride, positions);
    else if (stride == 3 * sizeof(Number))
        all_fit = copy_row<Number>(first[0], positions);
    else
        for (std::size_t i = 0; i < positions.size() / 3; ++i)
            all_fit &= copy_row<Number>(first[0] + i * stride, positions.subspan(3 * i).first<3>());
    if (all_fit) return;
    for (std::size_t i = 0; i < positions.size() / 3; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const auto number = number_at<Number>(first[axis] + i * stride);
                !is_position(static_cast<float>(number)))
                refuse(i, axis, number);
}

}  // namespace

StridedPositions::StridedPositions(const float* first, std::size_t count, std::size_t stride)
    : first_(places_from(first)), count_(count), stride_(stride), is_float64_(false) {
    check(first != nullptr, count, stride, sizeof(float), 3);
}
StridedPositions::StridedPositions(const double* first, std::size_t count, std::size_t stride)
    : first_(places_from(first)), count_(count), stride_(stride), is_float64_(true) {
    check(first != nullptr, count, stride, sizeof(double), 3);
}
StridedPositions::StridedPositions(const std::array<const float*, 3>& first, std::size_t count, std::size_t stride)
    : first_(places_of(first)), count_(count), stride_(stride), is_float64_(false) {
    check(all_set(first_), count, stride, sizeof(float), 1);
}
StridedPositions::StridedPositions(const std::array<const double*, 3>& first, std::size_t count, std::size_t stride)
    : first_(places_of(first)), count_(count), stride_(stride), is_float64_(true) {
    check(all_set(first_), count, stride, sizeof(double), 1);
}
StridedPositions::StridedPositions(std::span<const float> numbers)
    : StridedPositions(numbers.data(), particles_in(numbers.size())) {}
StridedPositions::StridedPositions(std::span<const double> numbers)
    : StridedPositions(numbers.data(), particles_in(numbers.size())) {}

void StridedPositions::copy_to(std::span<float> positions) const {
    if (positions.size() != 3 * count_)
        throw InvalidInput("there is room for " + std::to_string(positions.size()) +
                           " coordinates, must be three for " + "each of " + std::to_string(count_) + " particles");
    if (is_float64_)
        copy_numbers<double>(first_, stride_, positions);
    else
        copy_numbers<float>(first_, stride_, positions);
}

}  // namespace meniscus
