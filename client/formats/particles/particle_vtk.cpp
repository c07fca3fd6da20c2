#include <utility>

#include "formats/particles/particle_readers.hpp"
#include "formats/vtk/vtk_dataset.hpp"

namespace meniscus::formats {
namespace {

/// Throws InvalidInput for a finite coordinate beyond float32.
Particles to_particles(VtkDataset dataset, const ByteCursor& at) {
    Particles particles;
    particles.positions.reserve(3 * dataset.points.size());
    for (std::size_t i = 0; i < dataset.points.size(); ++i)
        for (const double x : dataset.points[i]) set_coordinate(particles, particles.positions.size(), x, at);
    particles.levels = std::move(dataset.levels);
    particles.faces = dataset.faces;
    dataset.arrays.finish(particles.arrays, particles.left_out);
    return particles;
}

}  // namespace

Particles read_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    return to_particles(read_legacy_vtk(name, bytes, limits, VtkUse::particles), ByteCursor(name, bytes));
}

Particles read_vtk_xml(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    return to_particles(read_xml_vtk(name, bytes, limits, VtkUse::particles), ByteCursor(name, bytes));
}

}  // namespace meniscus::formats
