#include "picture/shown_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "formats/containers/array_collector.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "picture/id_palette.hpp"

namespace meniscus::cli {
namespace {

constexpr std::string_view component_names = "xyzw";

struct Asked {
    std::string name;
    std::optional<std::size_t> component;
};

Asked parse(const std::string& what) {
    if (what.size() > 2 && what[what.size() - 2] == '.') {
        const std::size_t component = component_names.find(what.back());
        if (component != std::string_view::npos) return {what.substr(0, what.size() - 2), component};
    }
    return {what, std::nullopt};
}

const formats::NamedValues& find(const formats::TriangleMesh& mesh, const Asked& asked) {
    auto found = std::ranges::find(mesh.attributes, asked.name, &formats::NamedValues::name);
    if (found == mesh.attributes.end())  // as the file of the particles spelled it
        found = std::ranges::find(mesh.attributes, formats::array_name(asked.name), &formats::NamedValues::name);
    if (found == mesh.attributes.end()) {
        std::vector<std::string_view> names;
        for (const formats::NamedValues& attribute : mesh.attributes) names.push_back(attribute.name);
        throw InvalidInput("the mesh has no attribute '" + asked.name + "' to color by; it has " +
                           (names.empty() ? "none: reconstruct --attribute NAME keeps them" : listed(names)));
    }
    if (asked.component && *asked.component >= found->components)
        throw InvalidInput("attribute '" + asked.name + "' has no component " +
                           std::string(1, component_names[*asked.component]) + ": it has " +
                           std::to_string(found->components));
    return *found;
}

template <class Number>
Number number_at(const formats::NamedValues& values, std::size_t place) {
    Number number;
    std::memcpy(&number, values.data.data() + place * sizeof(Number), sizeof number);
    return number;
}

double value_at(const formats::NamedValues& values, std::size_t place) {
    switch (values.type) {
        case ElementType::float32:
            return static_cast<double>(number_at<float>(values, place));
        case ElementType::uint8:
            return number_at<std::uint8_t>(values, place);
        case ElementType::int32:
            return number_at<std::int32_t>(values, place);
        case ElementType::uint32:
            return number_at<std::uint32_t>(values, place);
    }
    return 0.0;
}

bool is_color(const formats::NamedValues& values) {
    return values.type == ElementType::uint8 && values.components >= 3 &&
           (values.name == "color" || values.name == "rgb" || values.name == "rgba");
}

float magnitude(const formats::NamedValues& values, std::size_t vertex) {
    double sum = 0.0;
    for (std::size_t c = 0; c < values.components; ++c) {
        const double value = value_at(values, vertex * values.components + c);
        sum += value * value;
    }
    return static_cast<float>(std::sqrt(sum));
}

void add_numbers(ShownValues& shown, const formats::NamedValues& values, std::optional<std::size_t> component) {
    if (values.components == 1) component = 0;
    shown.numbers.reserve(values.count());
    for (std::size_t v = 0; v < values.count(); ++v)
        shown.numbers.push_back(component ? static_cast<float>(value_at(values, v * values.components + *component))
                                          : magnitude(values, v));
    if (shown.numbers.empty()) return;
    const auto [low, high] = std::ranges::minmax(shown.numbers);
    shown.range = ValueRange{static_cast<double>(low), static_cast<double>(high)};
}

}  // namespace

ShownValues values_to_show(const formats::TriangleMesh& mesh, const std::string& what) {
    const Asked asked = parse(what);
    const formats::NamedValues& values = find(mesh, asked);
    ShownValues shown;
    shown.title = what;
    if (is_id(values.type)) {
        shown.nearest = true;
        for (std::size_t v = 0; v < values.count(); ++v)
            shown.colors.push_back(color_of_id(number_at<std::uint32_t>(values, v)));
    } else if (is_color(values) && !asked.component) {
        for (std::size_t v = 0; v < values.count(); ++v) {
            const std::size_t at = v * values.components;
            shown.colors.push_back({number_at<std::uint8_t>(values, at), number_at<std::uint8_t>(values, at + 1),
                                    number_at<std::uint8_t>(values, at + 2)});
        }
    } else {
        if (values.components > 1 && !asked.component) shown.title += ", magnitude";
        add_numbers(shown, values, asked.component);
    }
    return shown;
}

}  // namespace meniscus::cli
