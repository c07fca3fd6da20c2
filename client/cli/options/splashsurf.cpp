#include "cli/options/splashsurf.hpp"

#include <cstddef>

namespace meniscus::cli {
namespace {

/// Whether the option is in a list with commas.
bool is_in(std::string_view option, std::string_view list) {
    while (!list.empty()) {
        const std::size_t comma = list.find(", ");
        if (list.substr(0, comma) == option) return true;
        if (comma == std::string_view::npos) break;
        list.remove_prefix(comma + 2);
    }
    return false;
}

}  // namespace

std::string splashsurf_option(std::string_view command, std::string_view option) {
    const bool has_value = option.size() > 2 && option[1] != '-' && option[2] >= '0' && option[2] <= '9';
    const std::string_view name = has_value ? option.substr(0, 2) : option;
    for (const auto& [options, here, differs] : splashsurf_rows) {
        const std::size_t begin = options.starts_with('-') ? 0 : options.find(' ') + 1;
        const std::string_view of = begin == 0 ? "reconstruct" : options.substr(0, begin - 1);
        if (command != of || !is_in(name, options.substr(begin))) continue;
        if (here.empty()) return std::string(differs);
        return "here " + std::string(here) + (differs.empty() ? "" : "; " + std::string(differs));
    }
    return {};
}

}  // namespace meniscus::cli
