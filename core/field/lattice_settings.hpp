// The user's settings in the lattice's terms.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "field/smooth_field.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "lattice/lattice_part.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

inline constexpr unsigned particle_level_count = max_particle_level + 1;

/// All that the loops and kernels see of the settings.
struct LatticeSettings {
    double cell_size = 0.0;         ///< c, world units
    double units_per_length = 0.0;  ///< 4096 / c
    double rest_distance = 0.0;     ///< of particles of level 0 in water, two radii; units
    double work_limit = 0.0;        ///< most work of a frame, see BackendOptions

    // An element for each particle level.
    std::array<float, particle_level_count> support{};            ///< h, units
    std::array<float, particle_level_count> inverse_support{};    ///< 1 / h, see inverse_support()
    std::array<std::int64_t, particle_level_count> cell_units{};  ///< edge of a support cell, see support_cell_units()

    // The field.
    bool divides_by_density = false;  ///< whether the field is color
    bool has_own_supports = false;    ///< whether the field is smooth
    SmoothField smooth;
    bool leaves_out_spray = false;  ///< whether spray is left out: Spray::discard and Spray::points
    bool lists_spray = false;       ///< whether spray is listed: Spray::points
    std::array<float, particle_level_count>
        company_support{};  ///< support of the count of others, units; smooth field only
    /// m / rho0 times the kernel's W0 = 16 / (pi h^3): both scale with 2^3k, so that all particle levels share it.
    float weight = 0.0F;
    float iso = 0.0F;

    // The criterion of step 2. Neither counts nor bends: Mode::uniform.
    bool is_adaptive = false;
    bool measures_bends = false;    ///< whether CurvatureCriterion decides
    bool counts_particles = false;  ///< whether CountCriterion decides
    float tolerance = 0.0F;         ///< of CurvatureCriterion, in cells
    std::uint32_t count_threshold = 1;
    float deep_inside = std::numeric_limits<float>::infinity();  ///< least value of deep cells, see BandTest
    float blob_closest = 0.75F;                                  ///< threshold of CellReach::closest, see BlobRule
    int blob_level = 2;

    // Vertices.
    bool bisects = false;
    std::uint32_t bisection_steps = 0;  ///< number of steps on a finest edge
    std::uint32_t offset_bits = 6;
    bool has_normals = true;
    bool may_have_attributes = false;  ///< whether vertices may have attributes, see AttributeNumbers

    bool has_domain = false;
    Int3 domain_low, domain_high;  ///< in cells, rounded outward
    LatticePart part;              ///< the whole, unless a frame is reconstructed in parts

    /// Whether base cells are left out however near particles are.
    MENISCUS_HD bool leaves_cells_out() const { return has_domain || !part.is_whole; }

    /// Whether vertices of coarse edges lie half a sagitta out (steps/place_vertices/coarse_edges.hpp).
    MENISCUS_HD bool moves_coarse_vertices() const { return measures_bends && !bisects; }

    /// The settings must be valid.
    explicit LatticeSettings(const Settings& settings);
};

}  // namespace meniscus
