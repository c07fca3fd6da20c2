// The field of a frame's particles: sums over the particles near a block, eight points at a time.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "backends/cpu/field_source.hpp"
#include "backends/cpu/particle_sets.hpp"
#include "backends/cpu/surface.hpp"
#include "stages/sample_field.hpp"
#include "stages/split_cells.hpp"

namespace meniscus::cpu {

/// The particles of one level near a box, as a structure of arrays, in the order of summation.
struct Candidates {
    explicit Candidates(const std::shared_ptr<MemoryAccount>& account);

    Array<float> x, y, z, weight;
    std::size_t count = 0;
    float inverse_support = 0.0F;

    void gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box);
    void reserve(std::size_t n);
};

class ParticleField final : public FieldSource {
public:
    ParticleField(const std::shared_ptr<MemoryAccount>& account, Workers& workers, ParticleSets& sets);

    /// Divides the particles' weights by the density at their places: the color field.
    void divide_weights_by_density();

    /// Step 2's samples: the value at every stored block's base vertex, and a bound of the field in the whole cell.
    void sample_base_vertices(Surface& surface, Array<float>& bounds);

    void values(const Int3& base_cell, PointList& points, float* values, unsigned worker) override;
    void gradients(const Int3& base_cell, PointList& points, float* x, float* y, float* z, unsigned worker) override;

private:
    using Scratch = std::array<Candidates, particle_level_count>;

    void gather(const Units3& origin, const UnitBox& box, Scratch& scratch) const;
    void gather(const Int3& base_cell, const PointList& points, Scratch& scratch) const;
    /// Gives every worker room for the longest list that any has met, so that a warm frame allocates nothing.
    void even_out_scratch();

    Workers& workers_;
    ParticleSets& sets_;
    std::vector<Scratch> scratch_;
};

}  // namespace meniscus::cpu
