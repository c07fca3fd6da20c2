// The field of a frame's particles: sums over the particles near a block, a register of points at a time.
#pragma once

#include "field/cubic_spline.hpp"
#include "field/poly6.hpp"
#include "neighbors/cpu/field_source.hpp"
#include "neighbors/cpu/neighbor_search.hpp"

namespace meniscus::cpu {

/// Kernel: CubicSpline or Poly6.
template <class Kernel>
class ParticleField final : public FieldSource {
public:
    explicit ParticleField(NeighborSearch& search) : search_(search) {}

    void values(const Int3& base_cell, PointList& points, float* values, unsigned worker) override;
    void cluster_values(const Int3& lowest_base_cell, const ClusterPoints& points, ClusterValues& values,
                        unsigned worker) override;
    void normals(const Int3& base_cell, PointList& points, const NormalRows& normals, unsigned worker) override;
    std::size_t attributes(const Int3& base_cell, PointList& points, const AttributeNumbers& numbers, unsigned group,
                           const NormalRows* normals, GroupValues& values, unsigned worker) override;

private:
    void whole_block_values(const Int3& base_cell, float* values, unsigned worker);
    void block_values(const Int3& base_cell, BlockMask points, float* values, unsigned worker);

    /// Values where no particle has a share: those of the nearest, or 0. Returns at how many points there is none.
    std::size_t fill_gaps(const Int3& base_cell, const PointList& points, const AttributeNumbers& numbers,
                          unsigned group, GroupValues& values) const;
    NearestParticle nearest_particle(const Int3& base_cell, float x, float y, float z) const;

    NeighborSearch& search_;
};

extern template class ParticleField<CubicSpline>;
extern template class ParticleField<Poly6>;

}  // namespace meniscus::cpu
