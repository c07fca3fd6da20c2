// Positions as a program has them: float32 or float64, one after the other, within larger records, or axis by axis.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace meniscus {

/// Borrowed. Three numbers per particle: x y z next to each other, or in an array for each axis.
class StridedPositions {
public:
    /// first: x of the first particle; it need not be aligned. stride: bytes from one particle to the next, at least
    /// three numbers. Throws InvalidInput for a smaller stride, or for particles without memory.
    StridedPositions(const float* first, std::size_t count, std::size_t stride = 3 * sizeof(float));
    StridedPositions(const double* first, std::size_t count, std::size_t stride = 3 * sizeof(double));
    /// first: x, y and z of the first particle. stride: bytes from one of them to the next particle's, at least one
    /// number. Throws likewise.
    StridedPositions(const std::array<const float*, 3>& first, std::size_t count, std::size_t stride = sizeof(float));
    StridedPositions(const std::array<const double*, 3>& first, std::size_t count, std::size_t stride = sizeof(double));
    /// One particle after the other. Throws InvalidInput unless there are three numbers for each.
    StridedPositions(std::span<const float> numbers);
    StridedPositions(std::span<const double> numbers);

    /// Number of particles.
    std::size_t count() const noexcept { return count_; }
    /// Writes x y z per particle, 3 count() numbers; float64 is rounded to the nearest float32. Throws InvalidInput for
    /// another number of numbers, and, with the particle and its value, for one of them that is not finite, or that
    /// float32 cannot hold; what was written by then is undefined.
    void copy_to(std::span<float> positions) const;

private:
    std::array<const std::byte*, 3> first_;  ///< x, y, z
    std::size_t count_;
    std::size_t stride_;
    bool is_float64_;
};

}  // namespace meniscus
