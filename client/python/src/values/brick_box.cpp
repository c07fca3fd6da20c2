#include "values/brick_box.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "meniscus/error.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

constexpr std::size_t axes = 3;

/// Throws pybind11::error_already_set for what is no sequence.
py::list list_of(const py::handle& given, std::size_t size) {
    auto list = py::reinterpret_steal<py::object>(PySequence_List(given.ptr()));
    if (!list) throw py::error_already_set();
    if (py::len(list) != size) throw py::value_error();
    return list;
}

/// An axis with None stays as it is. Throws as list_of(), and pybind11::cast_error for a number of more bits.
void read(const py::handle& given, BrickCoordinate& place) {
    const py::list numbers = list_of(given, axes);
    for (std::size_t axis = 0; axis < axes; ++axis) {
        if (numbers[axis].is_none()) continue;
        const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(py::object(numbers[axis]).ptr()));
        if (!number) throw py::error_already_set();
        place.at(axis) = number.cast<std::int32_t>();
    }
}

}  // namespace

BrickBox brick_box(const py::object& given, const char* name) {
    if (given.is_none()) return all_bricks;
    constexpr auto no_end = std::numeric_limits<std::int32_t>::max();
    BrickCoordinate lowest{-no_end, -no_end, -no_end};
    BrickCoordinate highest{no_end, no_end, no_end};
    const auto refuse = [&] {
        throw InvalidInput(std::string(name) + " is " + std::string(py::repr(given)) +
                           ", must be (lowest, highest), each x y z: whole numbers of 32 bits, or None for no end");
    };
    try {
        const py::list ends = list_of(given, 2);
        read(ends[0], lowest);
        read(ends[1], highest);
    } catch (const py::error_already_set&) {
        refuse();
    } catch (const py::builtin_exception&) {
        refuse();
    }
    return bricks_between(lowest, highest);
}

}  // namespace meniscus::python
