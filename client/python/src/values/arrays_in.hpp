// Particles from numpy, copied: what a caller's other threads do to the arrays meanwhile changes nothing.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meniscus/particle_frame.hpp"
#include "meniscus/strided_positions.hpp"

namespace meniscus::python {

/// Whether the numbers are of this type, in the machine's byte order, and lie in C order.
bool is_of(const pybind11::array& array, const pybind11::dtype& type);
bool is_c_order(const pybind11::array& array);
/// None of the types of the library's arrays: no value.
std::optional<ElementType> element_type_of(const pybind11::array& array);

/// The arrays of one call, as meniscus/arrays.py makes them: borrowed from numpy as long as the interpreter's lock is
/// held and the call's arguments live.
struct GivenFrame {
    StridedPositions positions;
    std::span<const std::uint8_t> levels;
    std::vector<ParticleArray> arrays;  ///< names are those of `names`
    std::vector<std::string> names;
};

/// Checks forms again, for nothing that is passed may crash. Throws InvalidInput for another type, shape or order than
/// arrays.py makes, and for lengths that do not match; LimitExceeded for too many arrays or particles.
GivenFrame given_frame(const pybind11::object& positions, const pybind11::object& levels,
                       const pybind11::sequence& arrays);

/// A frame with memory of its own, which stays for the next one.
class OwnedFrame {
public:
    OwnedFrame() = default;
    /// Copies once, with the interpreter's lock. Throws InvalidInput for a position that is not finite, with the
    /// particle.
    void take(const GivenFrame& given);
    /// Borrows from here.
    ParticleFrame frame() const;
    /// Gives the memory back.
    void clear() { *this = {}; }

private:
    std::vector<float> positions_;
    std::vector<std::uint8_t> levels_;
    std::vector<std::string> names_;
    std::vector<std::vector<std::byte>> values_;
    std::vector<ParticleArray> arrays_;
};

}  // namespace meniscus::python
