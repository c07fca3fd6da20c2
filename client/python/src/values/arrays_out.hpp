// numpy arrays of the library's memory.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "meniscus/element_type.hpp"

namespace meniscus::python {

/// Makes the array read-only.
pybind11::array read_only(pybind11::array array);

/// (rows,) or (rows, columns), read-only; nothing is copied. columns: 0 for an array of one dimension. owner: keeps the
/// memory alive.
pybind11::array view(const pybind11::dtype& type, std::size_t rows, std::size_t columns, const void* data,
                     const pybind11::handle& owner);

/// numpy's type of these numbers.
pybind11::dtype dtype_of(ElementType type);

/// The columns of an array with `components` numbers for each row: one number makes an array of one dimension.
constexpr std::size_t columns_of(std::size_t components) {
    return components == 1 ? 0 : components;
}

/// A read-only array that owns the numbers that fill(Number*) sets. rows, columns: as those of view().
template <class Number, class Fill>
pybind11::array filled_array(std::size_t rows, std::size_t columns, const Fill& fill) {
    std::unique_ptr<Number[]> numbers(new Number[rows * (columns == 0 ? 1 : columns)]);
    fill(numbers.get());
    // numpy cannot make an array writable whose owner is none of its own.
    const pybind11::capsule owner(numbers.get(), [](void* all) { delete[] static_cast<Number*>(all); });
    return view(pybind11::dtype::of<Number>(), rows, columns, numbers.release(), owner);
}

/// An array that owns the numbers, which may be changed; nothing is copied. type: of the array's numbers.
template <class Element>
pybind11::array array_of(std::vector<Element>&& elements, const pybind11::dtype& type, std::size_t columns) {
    auto kept = std::make_unique<std::vector<Element>>(std::move(elements));
    const std::size_t row_bytes = static_cast<std::size_t>(type.itemsize()) * (columns == 0 ? 1 : columns);
    const std::size_t rows = kept->size() * sizeof(Element) / row_bytes;
    std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(rows)};
    if (columns != 0) shape.push_back(static_cast<pybind11::ssize_t>(columns));
    const void* const data = kept->data();
    const pybind11::capsule owner(kept.get(), [](void* all) { delete static_cast<std::vector<Element>*>(all); });
    static_cast<void>(kept.release());
    return pybind11::array(type, shape, data, owner);
}

}  // namespace meniscus::python
