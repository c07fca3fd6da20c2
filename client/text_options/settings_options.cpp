#include "text_options/settings_options.hpp"

#include <variant>

#include "meniscus/error.hpp"
#include "text_options/attribute_options.hpp"

namespace meniscus::text_options {
namespace {

/// The alternative that `option` names; one that the preset has chosen already keeps its parameters.
template <class Choice>
void read_alternative(OptionReader& options, std::string_view option, Choice& choice) {
    Choice given = choice;
    options.read_choice(option, given);
    if (given.index() != choice.index()) choice = given;
}

/// The parameter of one alternative; refused with another, where it would change nothing.
template <class Alternative, class Choice, class Parameter>
void read_parameter(OptionReader& options, std::string_view option, std::string_view of, Choice& choice,
                    Parameter Alternative::*parameter) {
    const std::string* const text = options.find(option);
    if (text == nullptr) return;
    auto* const chosen = std::get_if<Alternative>(&choice);
    if (chosen == nullptr)
        throw InvalidInput(options.quoted(option) + " is '" + *text + "', but '" + options.naming()(of) + "' is " +
                           std::string(name_of(choice)) + ": set it to " + std::string(Alternative::name) +
                           ", or leave the option out");
    options.read(option, chosen->*parameter);
}

}  // namespace

Settings read_settings(OptionReader& options) {
    Preset named = Preset::smooth;
    options.read_choice("preset", named);
    double particle_radius = 0.0;
    if (options.find("particle-radius") == nullptr)
        throw InvalidInput(options.quoted("particle-radius") +
                           " is not set, must be the particles' radius in world units");
    options.read("particle-radius", particle_radius);
    Settings settings = preset(named, particle_radius);
    options.read("cell-size", settings.cell_size);
    options.read("iso", settings.iso);
    options.read_choice("field", settings.field);
    options.read("smoothness", settings.smoothness);
    options.read_choice("spray", settings.spray);
    options.read("smoothing-length", settings.smoothing_length);
    options.read_choice("mode", settings.mode);
    read_alternative(options, "criterion", settings.criterion);
    read_parameter(options, "tolerance", "criterion", settings.criterion, &CurvatureCriterion::tolerance);
    read_parameter(options, "count-threshold", "criterion", settings.criterion, &CountCriterion::threshold);
    read_alternative(options, "edge-points", settings.edge_points);
    read_parameter(options, "bisection-steps", "edge-points", settings.edge_points, &Bisection::steps);
    options.read("normals", settings.normals);
    options.read("domain", settings.domain);
    read_attributes(options, settings);
    validate(settings);
    return settings;
}

}  // namespace meniscus::text_options
