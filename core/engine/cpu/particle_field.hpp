// The field of a frame's particles: sums over the particles near a block, eight points at a time.
#pragma once

#include <memory>
#include <vector>

#include "engine/cpu/candidates.hpp"
#include "engine/cpu/field_source.hpp"
#include "engine/cpu/surface.hpp"
#include "particles/particle_sets.hpp"
#include "steps/split_cells/split_cells.hpp"

namespace meniscus::cpu {

class ParticleField final : public FieldSource {
public:
    ParticleField(const std::shared_ptr<MemoryAccount>& account, Workers& workers, ParticleSets& sets);

    /// After the particle sets have changed. Divides the particles' weights by the density at their places if the field
    /// is the color field.
    void begin_frame(Field field);

    /// Step 2's samples: the value at every stored block's base vertex, and what its particles may do in the whole
    /// cell.
    void sample_base_vertices(Surface& surface, Array<CellReach>& reaches);
    /// How much the surface bends in every cell of the band.
    void measure_bends(Surface& surface, const Array<CellReach>& reaches, Array<CellBend>& bends);

    void values(const Int3& base_cell, PointList& points, float* values, unsigned worker) override;
    void cluster_values(const Int3& lowest_base_cell, const ClusterPoints& points, ClusterValues& values,
                        unsigned worker) override;
    void normals(const Int3& base_cell, PointList& points, float* x, float* y, float* z, unsigned worker) override;

private:
    void whole_block_values(const Int3& base_cell, float* values, unsigned worker);
    void block_values(const Int3& base_cell, BlockMask points, float* values, unsigned worker);
    void divide_weights_by_density();
    /// Of the set's particles in one of its bricks.
    void find_densities(ParticleSet& set, const Brick& brick, unsigned worker);
    /// The particles near a cluster, from the last call if it asked for the same one.
    const CandidateLists::Levels& near_cluster(const Int3& base_cell, unsigned worker);
    const CandidateLists::Levels& near_box(const Int3& base_cell, const UnitBox& box, unsigned worker);
    /// Gives every worker room for the longest lists that any has met, so that a warm frame allocates nothing.
    void even_out_lists();

    Workers& workers_;
    ParticleSets& sets_;
    std::vector<CandidateLists> lists_;  ///< one of each worker
};

}  // namespace meniscus::cpu
