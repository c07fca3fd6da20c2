#include "text_options/option_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "meniscus/error.hpp"
#include "meniscus/number_text.hpp"
#include "meniscus/quoted.hpp"
#include "meniscus/seconds.hpp"

namespace meniscus::text_options {
namespace {

/// Whatever the locale. The whole text must be the number.
template <class Number>
bool is_number(std::string_view text, Number& value) {
    const char* const end = text.data() + text.size();
    const auto [stopped_at, error] = read_number(text.data(), end, value);
    return error == std::errc() && stopped_at == end;
}

/// option: quoted.
[[noreturn]] void refuse(const std::string& option, std::string_view text, const std::string& wanted) {
    throw InvalidInput(option + " is " + quoted(text) + ", must be " + wanted);
}

double number(const std::string& option, std::string_view text) {
    double value = 0.0;
    if (!is_number(text, value)) refuse(option, text, "a number such as 0.5");
    return value;
}

/// As many numbers as `values` has room for, with spaces between them.
void numbers(const std::string& option, std::string_view text, std::span<double> values) {
    const std::string wanted = std::to_string(values.size()) + " numbers with spaces between them";
    std::string_view rest = text;
    for (double& value : values) {
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        const std::string_view word = rest.substr(0, rest.find(' '));
        if (!is_number(word, value)) refuse(option, text, wanted);
        rest.remove_prefix(word.size());
    }
    if (rest.find_first_not_of(' ') != std::string_view::npos) refuse(option, text, wanted);
}

}  // namespace

std::string plain_naming(std::string_view name) {
    return std::string(name);
}

std::string OptionReader::quoted(std::string_view name) const {
    return "option '" + naming_(name) + "'";
}

const std::string* OptionReader::find(std::string_view name) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.emplace_back(name);
    if (options_ == nullptr) return nullptr;
    const auto found = options_->find(name);
    return found == options_->end() ? nullptr : &found->second;
}

void OptionReader::read(std::string_view name, std::string& value) {
    if (const std::string* text = find(name)) value = *text;
}

void OptionReader::read(std::string_view name, bool& value) {
    const std::string* text = find(name);
    if (text == nullptr) return;
    if (*text != "true" && *text != "false") refuse(quoted(name), *text, "true or false");
    value = *text == "true";
}

void OptionReader::read(std::string_view name, double& value) {
    if (const std::string* text = find(name)) value = number(quoted(name), *text);
}

void OptionReader::read(std::string_view name, std::optional<Box>& value) {
    const std::string* text = find(name);
    if (text == nullptr) return;
    std::array<double, 6> corners{};
    numbers(quoted(name), *text, corners);
    value = Box{{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}};
}

void OptionReader::read(std::string_view name, std::optional<std::array<double, 3>>& value) {
    const std::string* text = find(name);
    if (text == nullptr) return;
    value.emplace();
    numbers(quoted(name), *text, *value);
}

void OptionReader::read(std::string_view name, std::chrono::milliseconds& value) {
    const std::string* text = find(name);
    if (text == nullptr) return;
    constexpr double most = 1e9;
    const double seconds = number(quoted(name), *text);
    // Also false for a NaN.
    if (!(seconds >= 0.0 && seconds <= most)) refuse(quoted(name), *text, "0 to 1000000000 seconds");
    value = milliseconds_of(seconds);
}

template <class Number>
Number OptionReader::whole_number(std::string_view name, const std::string& text) const {
    Number value{};
    if (is_number(text, value)) return value;
    std::int64_t negative = 0;
    if (std::is_unsigned_v<Number> && is_number(text, negative) && negative < 0)
        refuse(quoted(name), text, "a whole number, 0 or more");
    refuse(quoted(name), text,
           "a whole number, " + std::to_string(std::numeric_limits<Number>::min()) + " to " +
               std::to_string(std::numeric_limits<Number>::max()));
}
template int OptionReader::whole_number(std::string_view, const std::string&) const;
template std::uint32_t OptionReader::whole_number(std::string_view, const std::string&) const;
template std::uint64_t OptionReader::whole_number(std::string_view, const std::string&) const;

std::string number_text(double value) {
    // The shortest form of a round number has an exponent, as 1e+09, which options of whole numbers refuse.
    if (constexpr double first_inexact = 0x1p53; value == std::trunc(value) && std::abs(value) < first_inexact)
        return std::to_string(static_cast<std::int64_t>(value));
    std::string text;
    append_shortest(text, value);
    return text;
}

void OptionReader::finish() const {
    if (options_ == nullptr) return;
    for (const auto& [name, value] : *options_) {
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
        std::vector<std::string> named(known_.size());
        std::transform(known_.begin(), known_.end(), named.begin(),
                       [this](const std::string& known) { return naming_(known); });
        throw InvalidInput(quoted(name) + " is not known here, must be " +
                           listed(std::vector<std::string_view>(named.begin(), named.end())));
    }
}

}  // namespace meniscus::text_options
