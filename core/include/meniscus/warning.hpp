// Warnings of a frame that its owner surely did not mean: it is reconstructed as asked, with the warning beside it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "meniscus/described.hpp"
#include "meniscus/names.hpp"

namespace meniscus {

enum class WarningCode : std::uint8_t {
    unknown,           ///< a warning of a server that is newer than this program
    radius_too_small,  ///< the radius does not fit the particles' spacing. value: the radius, limit: the one that fits,
                       ///< world units
    radius_too_large,  ///< the same
    empty_surface,     ///< value: the greatest value of the field that was sampled, limit: that of the surface
    cell_size_too_large,  ///< to show the particles. value: the cell's edge, limit: the largest that does, world units
    support_too_small,    ///< to join the particles. value: the support, limit: the smallest that does, world units
};
constexpr std::string_view name_of(WarningCode code) {
    switch (code) {
        case WarningCode::unknown:
            return "unknown";
        case WarningCode::radius_too_small:
            return "radius_too_small";
        case WarningCode::radius_too_large:
            return "radius_too_large";
        case WarningCode::empty_surface:
            return "empty_surface";
        case WarningCode::cell_size_too_large:
            return "cell_size_too_large";
        case WarningCode::support_too_small:
            return "support_too_small";
    }
    return {};
}

/// The same for the same frame and settings on every backend. How each is found: core/README.md#warnings.
struct Warning {
    WarningCode code = WarningCode::unknown;
    double value = 0.0;  ///< the found value, as the code says
    double limit = 0.0;  ///< the limit that it is compared with, as the code says
    std::string text;    ///< the same in words, with what to do: one line of English

    template <class Visit>
    static void rows(const Visit& visit) {
        visit("code", &Warning::code, {.help = "such as radius_too_small"});
        visit("value", &Warning::value, {.help = "what was found"});
        visit("limit", &Warning::limit, {.help = "what it is held against"});
        visit("text", &Warning::text, {.help = "the same in words, with what to do"});
    }

    bool operator==(const Warning&) const = default;
};

}  // namespace meniscus
