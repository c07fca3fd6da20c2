// Decimal text of numbers, the same in every locale.
#pragma once

#include <charconv>
#include <concepts>
#include <string>

namespace meniscus {

/// Appends the shortest decimal that reads back as the same number, as std::to_chars() writes it.
void append_shortest(std::string& out, double value);
void append_shortest(std::string& out, float value);
template <std::integral Whole>
void append_shortest(std::string& out, Whole value) {
    out += std::to_string(value);
}

/// The number rounded to `digits` significant ones, as printf() writes it by %g.
std::string rounded_text(double value, int digits);

/// Reads the decimal that the characters begin with, as std::from_chars() does.
std::from_chars_result read_number(const char* first, const char* last, double& value);
template <std::integral Whole>
std::from_chars_result read_number(const char* first, const char* last, Whole& value) {
    return std::from_chars(first, last, value);
}

}  // namespace meniscus
