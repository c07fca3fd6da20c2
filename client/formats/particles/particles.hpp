// The particles of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/containers/named_values.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

class ByteCursor;

/// One frame of particles, owned.
struct Particles {
    std::vector<float> positions;      ///< x y z per particle, world units; may hold NaN or infinity if the file does
    std::vector<std::uint8_t> levels;  ///< empty, or one per particle, 0 (finest) to max_particle_level
    /// The other values of each particle, in the file's order, under array_name(): at most max_particle_arrays.
    std::vector<NamedValues> arrays{};
    /// A line for each array that the file has beside them, with the reason: "tensor (9 components)".
    std::vector<std::string> left_out{};

    /// Faces that the file has beside its points: it is a mesh, whose corners are taken as particles. 0 of particles.
    std::size_t faces = 0;
    /// The remainders of rounding `positions`: the file's coordinates are the sums, to 48 bits. Empty if all are 0.
    std::vector<float> remainders{};

    std::size_t count() const { return positions.size() / 3; }
    /// The coordinate as the file has it. index: into `positions`.
    double coordinate(std::size_t index) const {
        const auto rounded = static_cast<double>(positions[index]);
        return remainders.empty() ? rounded : rounded + static_cast<double>(remainders[index]);
    }
    /// The particles without arrays: the arrays' views have to lie somewhere, see views().
    ParticleFrame frame() const {
        ParticleFrame view;
        view.positions = positions;
        view.levels = levels;
        return view;
    }
};

/// The warning of a file with faces.
std::string corners_as_particles(std::size_t faces, std::size_t particles);

/// Throws InvalidInput, naming the arrays that the file has, unless these are among them. file: for messages.
void require_arrays(const std::string& file, const Particles& particles, std::span<const std::string> names);

/// Sets a coordinate of `positions`, by its index there, which may be one beyond the last; and its remainder. Throws as
/// to_coordinate() does.
void set_coordinate(Particles& particles, std::size_t index, double value, const ByteCursor& at);

}  // namespace meniscus::formats
