// Keywords of Python's side, which come as options: messages name the keyword.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "text_options/option_reader.hpp"

namespace meniscus::python {

/// The option's name in Python: "particle_radius" for "particle-radius".
std::string keyword_of(std::string_view option);

/// options: outlive the reader.
inline text_options::OptionReader reader_of(const text_options::Options& options) {
    return text_options::OptionReader(&options, keyword_of);
}

/// A text without a zero byte, where C would end it. Throws InvalidInput, with the name, for anything else.
std::string text_of(const pybind11::object& given, const std::string& name);

/// A whole number from 0 to `largest`. Throws InvalidInput, with the name, for anything else.
std::uint64_t whole_number(const pybind11::object& given, const std::string& name, std::uint64_t largest);

/// Of a frame. None: no index is given. Throws likewise.
std::optional<std::uint64_t> index_of(const pybind11::object& given);

}  // namespace meniscus::python
