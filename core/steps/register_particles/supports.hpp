// The smooth field's supports and weights: a particle among others reaches far, which makes the surface smooth; one
// alone stays a drop (core/README.md#the-smooth-field).
#pragma once

#include "field/lattice_settings.hpp"
#include "field/poly6.hpp"
#include "lattice/host_device.hpp"
#include "lattice/lattice_part.hpp"
#include "meniscus/mesh.hpp"
#include "particles/particle_key.hpp"

namespace meniscus {

// The company of a particle is the sum of poly6 kernels (1 at distance 0) over all particles, itself included, each
// with the company's support of its level.

/// Whether a particle is alone.
MENISCUS_HD inline bool is_spray(float company, const SmoothField& f) {
    return company - 1.0F <= f.least_company;
}

/// The kernel of a particle by its company.
MENISCUS_HD inline Poly6 fitted_kernel(float company, unsigned level, const SmoothField& f) {
    const auto cube = [](float v) { return v * v * v; };
    const float u = (company - 1.0F - f.least_company) / (f.full_company - f.least_company);
    const float clamped = max(min(u, 1.0F), 0.0F);
    const float t = clamped * clamped * fma(-2.0F, clamped, 3.0F);
    const float support = fma(t, f.widest_support - f.lone_support, f.lone_support);
    // The volume that the particle stands for, times the kernel's norm: among others by the density, alone so that the
    // field is 1 at its place.
    const float among_others = cube(f.company_support) / company;
    const float alone = cube(f.lone_support) / fma(f.shared_drop, company - 1.0F, 1.0F);
    const float weight = cube_root(fma(t, among_others, (1.0F - t) * alone)) / support;
    return {weight, Poly6::fall_of(weight, support * f.units_per_radius[level])};
}

/// The field at a particle's place has a least value: otherwise a few particles close together sink below the
/// threshold. value: the field there.
MENISCUS_HD inline Poly6 lifted_kernel(const Poly6& kernel, float value, const SmoothField& f) {
    if (kernel.weight == 0.0F) return kernel;
    const float share = kernel.weight * kernel.weight * kernel.weight;
    const float neighbors = value / share;
    // The company that fitted_kernel() had, for a particle among others.
    const float ratio = f.company_support / f.widest_support;
    const float company = ratio * ratio * ratio / share;
    const float squeezed = max(neighbors - f.group_size, 0.0F) * max(fma(-f.group_spread, neighbors, company), 0.0F);
    const float least = fma(f.group_lift, squeezed, f.least_value);
    if (value >= least) return kernel;
    const float lift = cube_root(least / value);
    return {kernel.weight * lift, kernel.fall * lift};
}

MENISCUS_HD inline Point spray_point(const ParticleKey& key, std::int64_t cell_units, double units_per_length) {
    const Units3 p = key_place(key, cell_units);
    const auto world = [&](std::int64_t v) { return static_cast<float>(static_cast<double>(v) / units_per_length); };
    return {world(p.x), world(p.y), world(p.z)};
}

/// Whether a particle lies in a base cell of the part's own: spray there is this part's to count and to list.
MENISCUS_HD inline bool lies_in_own_cell(const ParticleKey& key, std::int64_t cell_units, const LatticePart& part) {
    if (part.is_whole) return true;
    const Units3 p = key_place(key, cell_units);
    const auto cell = [](std::int64_t v) { return static_cast<std::int32_t>(floor_div(v, units_per_base_cell)); };
    return part.owns({cell(p.x), cell(p.y), cell(p.z)});
}

}  // namespace meniscus
