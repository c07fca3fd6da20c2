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

void check(const void* first, std::size_t count, std::size_t stride, std::size_t least_stride) {
    if (first == nullptr && count != 0)
        throw InvalidInput("the frame has " + std::to_string(count) + " particles, but no memory with their positions");
    if (stride < least_stride)
        throw InvalidInput("the stride is " + std::to_string(stride) + " bytes, must be at least " +
                           std::to_string(least_stride) + ": three numbers of " + std::to_string(least_stride / 3) +
                           " bytes");
    if (count > std::numeric_limits<std::size_t>::max() / stride)
        throw InvalidInput(std::to_string(count) + " particles with a stride of " + std::to_string(stride) +
                           " bytes are more than memory can hold");
}

template <class Number>
std::array<Number, 3> numbers_at(const std::byte* place) {
    std::array<Number, 3> position;
    std::memcpy(position.data(), place, sizeof position);
    return position;
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
        Number number;
        std::memcpy(&number, row + i * sizeof number, sizeof number);
        out[i] = static_cast<float>(number);
        misfits |= static_cast<unsigned>(!is_position(out[i]));
    }
    return misfits == 0;
}

template <class Number>
void copy_numbers(const std::byte* first, std::size_t stride, std::span<float> positions) {
    bool all_fit = true;
    if (stride == 3 * sizeof(Number))
        all_fit = copy_row<Number>(first, positions);
    else
        for (std::size_t i = 0; i < positions.size() / 3; ++i)
            all_fit &= copy_row<Number>(first + i * stride, positions.subspan(3 * i).first<3>());
    if (all_fit) return;
    for (std::size_t i = 0; i < positions.size() / 3; ++i) {
        const std::array<Number, 3> position = numbers_at<Number>(first + i * stride);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!is_position(static_cast<float>(position[axis]))) refuse(i, axis, position[axis]);
    }
}

}  // namespace

StridedPositions::StridedPositions(const float* first, std::size_t count, std::size_t stride)
    : first_(reinterpret_cast<const std::byte*>(first)), count_(count), stride_(stride), is_float64_(false) {
    check(first, count, stride, 3 * sizeof(float));
}
StridedPositions::StridedPositions(const double* first, std::size_t count, std::size_t stride)
    : first_(reinterpret_cast<const std::byte*>(first)), count_(count), stride_(stride), is_float64_(true) {
    check(first, count, stride, 3 * sizeof(double));
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
