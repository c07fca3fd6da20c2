// Values with a name, made of numbers and read back.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/containers/named_values.hpp"

namespace meniscus::test {

/// numbers: all of the first particle or vertex, then those of the next.
template <class Number>
formats::NamedValues values_of(const std::string& name, ElementType type, std::size_t components,
                               const std::vector<Number>& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    return {name, type, components, {bytes.begin(), bytes.end()}};
}

/// Of NamedValues or a ParticleArray.
template <class Number, class Values>
std::vector<Number> numbers_of(const Values& values) {
    std::vector<Number> numbers(values.data.size() / sizeof(Number));
    std::ranges::copy(values.data, std::as_writable_bytes(std::span(numbers)).begin());
    return numbers;
}

}  // namespace meniscus::test
