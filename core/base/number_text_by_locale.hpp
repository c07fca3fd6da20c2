// The decimal text of numbers by the C library, for standard libraries without std::to_chars() and std::from_chars() of
// floating-point numbers. It follows the locale, which is therefore that of C for the time of a call, in this thread
// alone.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>

namespace meniscus::by_locale {

/// The locale of C, for as long as the object is there.
class ClassicLocale {
public:
    ClassicLocale() : before_(uselocale(classic())) {}
    ~ClassicLocale() { uselocale(before_); }
    ClassicLocale(const ClassicLocale&) = delete;
    ClassicLocale& operator=(const ClassicLocale&) = delete;

private:
    static locale_t classic() {
        static const locale_t made = newlocale(LC_ALL_MASK, "C", nullptr);
        return made;
    }
    locale_t before_;
};

/// format: of a precision and a number.
inline std::string printed(const char* format, int precision, double value) {
    const ClassicLocale locale;
    std::array<char, 512> text;  // a float64 has 309 digits before its point
    const int size = std::snprintf(text.data(), text.size(), format, precision, value);
    return {text.data(), static_cast<std::size_t>(size)};
}

inline float parsed(const std::string& text, float /*type*/) {
    return std::strtof(text.c_str(), nullptr);
}
inline double parsed(const std::string& text, double /*type*/) {
    return std::strtod(text.c_str(), nullptr);
}

/// As std::to_chars() writes a number: of the fewest digits that read back as the same, and of its two forms the
/// shorter. Next to a power of two it may take one digit more.
template <class Number>
std::string shortest(Number value) {
    if (!std::isfinite(value)) return printed("%.*g", 1, value);
    const ClassicLocale locale;
    int decimals = 0;
    std::string scientific = printed("%.*e", decimals, value);
    while (decimals + 1 < std::numeric_limits<Number>::max_digits10 && parsed(scientific, value) != value)
        scientific = printed("%.*e", ++decimals, value);
    const int exponent = std::atoi(scientific.c_str() + scientific.find('e') + 1);
    const std::string fixed = printed("%.*f", std::max(decimals - exponent, 0), value);
    return fixed.size() <= scientific.size() ? fixed : scientific;
}

/// As std::from_chars() reads a number: without spaces, a plus or a hexadecimal form before it.
inline std::from_chars_result read_number(const char* first, const char* last, double& value) {
    const bool begins = first != last && (*first == '-' || *first == '.' || (*first >= '0' && *first <= '9') ||
                                          *first == 'i' || *first == 'I' || *first == 'n' || *first == 'N');
    if (!begins) return {first, std::errc::invalid_argument};
    const std::string text(first, std::find_if(first, last, [](char c) { return c == 'x' || c == 'X'; }));
    const ClassicLocale locale;
    char* end = nullptr;
    errno = 0;
    const double number = std::strtod(text.c_str(), &end);
    if (end == text.c_str()) return {first, std::errc::invalid_argument};
    const char* const stopped_at = first + (end - text.c_str());
    // The C library also reports numbers that are merely subnormal.
    if (errno == ERANGE && (number == 0.0 || std::isinf(number))) return {stopped_at, std::errc::result_out_of_range};
    value = number;
    return {stopped_at, std::errc()};
}

}  // namespace meniscus::by_locale
