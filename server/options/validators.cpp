#include "options/validators.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

namespace meniscus::server {

namespace {

/// None for anything else.
std::optional<double> number_up_to(double most, const std::string& text) {
    double number = 0.0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc{} && rest == text.data() + text.size() && number >= 0.0 && number <= most) return number;
    return std::nullopt;
}

}  // namespace

CLI::Validator whole_number() {
    return {[](std::string& text) -> std::string {
                std::uint64_t number = 0;
                const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
                if (error == std::errc::result_out_of_range)
                    return fmt::format("{} is more than {}", text, std::numeric_limits<std::uint64_t>::max());
                return error == std::errc{} ? "" : fmt::format("{} is no number from 0 on", text);
            },
            "", "whole number"};
}

CLI::Validator up_to(double most) {
    return {[most](std::string& text) -> std::string {
                return number_up_to(most, text) ? "" : fmt::format("{} is no number from 0 to {}", text, most);
            },
            "", "number"};
}

CLI::Validator seconds_up_to(double most) {
    return {[most](std::string& text) -> std::string {
                constexpr double least = 0.001;
                const auto seconds = number_up_to(most, text);
                if (seconds && (*seconds == 0.0 || *seconds >= least)) return "";
                return fmt::format("{} is no number of seconds: 0, or from {} to {}", text, least, most);
            },
            "", "seconds"};
}

}  // namespace meniscus::server
