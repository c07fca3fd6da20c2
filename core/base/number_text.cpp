#include "meniscus/number_text.hpp"

#include <array>
#include <cstddef>

#ifndef __cpp_lib_to_chars
#include "base/number_text_by_locale.hpp"
#endif

namespace meniscus {

#ifdef __cpp_lib_to_chars

namespace {

/// The shortest form of a float64 has 24 characters at most.
using Digits = std::array<char, 32>;

template <class Number>
void append(std::string& out, Number value) {
    Digits digits;
    out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

}  // namespace

void append_shortest(std::string& out, double value) {
    append(out, value);
}
void append_shortest(std::string& out, float value) {
    append(out, value);
}

std::string rounded_text(double value, int digits) {
    Digits text;
    return {text.data(),
            std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr};
}

std::from_chars_result read_number(const char* first, const char* last, double& value) {
    return std::from_chars(first, last, value);
}

#else  // a standard library that has them for whole numbers alone, such as gcc 10's

void append_shortest(std::string& out, double value) {
    out += by_locale::shortest(value);
}
void append_shortest(std::string& out, float value) {
    out += by_locale::shortest(value);
}

std::string rounded_text(double value, int digits) {
    return by_locale::printed("%.*g", digits, value);
}

std::from_chars_result read_number(const char* first, const char* last, double& value) {
    return by_locale::read_number(first, last, value);
}

#endif

}  // namespace meniscus
