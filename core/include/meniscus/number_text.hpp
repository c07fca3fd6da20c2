// Decimal text of floating-point numbers, the same in every locale.
#pragma once

#include <charconv>
#include <string>

namespace meniscus {

/// Appends the shortest decimal that reads back as the same number, as std::to_chars() writes it.
void append_shortest(std::string& out, double value);
void append_shortest(std::string& out, float value);

/// The number rounded to `digits` significant ones, as printf() writes it by %g.
std::string rounded_text(double value, int digits);

/// Reads the decimal that the characters begin with, as std::from_chars() does.
std::from_chars_result read_number(const char* first, const char* last, double& value);

}  // namespace meniscus
