#include "text_options/settings_options.hpp"

#include "meniscus/error.hpp"
#include "text_options/attribute_options.hpp"
#include "text_options/row_options.hpp"

namespace meniscus::text_options {
Settings read_settings(OptionReader& options) {
    Preset named = Preset::smooth;
    options.read_choice("preset", named);
    double particle_radius = 0.0;
    if (options.find("particle-radius") == nullptr)
        throw InvalidInput(options.quoted("particle-radius") +
                           " is not set, must be the particles' radius in world units");
    options.read("particle-radius", particle_radius);
    Settings settings = preset(named, particle_radius);
    read_rows(options, settings);
    read_attributes(options, settings);
    validate(settings);
    return settings;
}

}  // namespace meniscus::text_options
