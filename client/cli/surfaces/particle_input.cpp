#include "cli/surfaces/particle_input.hpp"

#include <algorithm>

#include "editing/particle_box.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/particles/particle_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

/// The distance, in particle radii, by which a particle may be moved before the surface shows it.
constexpr double noticed_rounding = 0.01;

}  // namespace

ParticleInput::ParticleInput(const std::filesystem::path& path, const ParticleInputOptions& options,
                             const Settings& settings)
    : particles_(formats::read_particles(path, options.format, options.limits)) {
    const std::string name = formats::input_name(path);
    if (particles_.faces != 0) warnings_.push_back(faces_as_particles(particles_.faces, particles_.count()));
    const std::size_t in_file = particles_.count();
    if (options.box) editing::keep_inside(particles_, *options.box);
    if (particles_.count() == 0) warnings_.push_back(no_particles(in_file));
    if (options.origin) editing::move_to(particles_, *options.origin);
    warn_of_rounding(settings.particle_radius);
    choose_arrays(settings, name);
    try {
        validate(exact(), settings);
    } catch (const InvalidInput& e) {
        throw InvalidInput(name + ": " + e.what() +
                           (options.box ? " (counted without those outside --particle-aabb)" : ""));
    }
    if (options.positions == PositionEncoding::uint16) quantized_.emplace(exact());
}

ParticleFrame ParticleInput::exact() const {
    ParticleFrame frame = particles_.frame();
    frame.arrays = arrays_;
    return frame;
}

void ParticleInput::warn_of_rounding(double particle_radius) {
    const double moved = editing::largest_remainder(particles_);
    const double limit = noticed_rounding * particle_radius;
    if (moved > limit) warnings_.push_back(positions_rounded(moved, limit, editing::middle_of(particles_)));
}

void ParticleInput::choose_arrays(const Settings& settings, const std::string& name) {
    if (settings.all_attributes) {
        for (const formats::NamedValues& array : particles_.arrays) arrays_.push_back(array.view());
        return;
    }
    // A frame of nothing needs none.
    if (particles_.count() > 0) formats::require_arrays(name, particles_, settings.attributes);
    for (const formats::NamedValues& array : particles_.arrays)
        if (std::find(settings.attributes.begin(), settings.attributes.end(), array.name) != settings.attributes.end())
            arrays_.push_back(array.view());
}

}  // namespace meniscus::cli
