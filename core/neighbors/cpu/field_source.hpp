// The interface of a field for the surface stages. Tests put white noise in place of particles.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "lattice/block_mask.hpp"
#include "lattice/coordinates.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "particles/attributes.hpp"

namespace meniscus::cpu {

/// Most points asked for at once: a block's vertices, or sixteen points of every block of a cluster.
inline constexpr std::size_t max_points = std::max(3 * 64, 16 * cluster_blocks);

/// Points in units from a base cell's corner; room for whole lanes.
struct PointList {
    std::size_t count = 0;
    alignas(64) float x[max_points];
    alignas(64) float y[max_points];
    alignas(64) float z[max_points];

    void add(float px, float py, float pz) {
        x[count] = px;
        y[count] = py;
        z[count] = pz;
        ++count;
    }
};

/// Room for max_points unit vectors.
struct NormalRows {
    float *x, *y, *z;
};

/// Four numbers at each of some points; and the sum of the particles' shares there, or for ids the largest share.
struct GroupValues {
    alignas(64) float of[group_size_of_numbers][max_points];
    alignas(64) float weight[max_points];
};

using ClusterPoints = std::array<BlockMask, cluster_blocks>;
/// Values at some points of the blocks of a cluster.
struct ClusterValues {
    /// Each block's values in the order of its points' bits. The caller sets the place for those of a whole block;
    /// others are in `room`, with whole lanes to read.
    std::array<float*, cluster_blocks> of;
    float room[64 * cluster_blocks + WideLanes::count];
};

/// Arrays have room for max_points elements; a list's lanes beyond its points may be overwritten. A value is a pure
/// function of the point's place in the world.
class FieldSource {
public:
    virtual ~FieldSource() = default;
    virtual void values(const Int3& base_cell, PointList& points, float* values, unsigned worker) = 0;
    /// The values at some lattice points of the blocks of a cluster (clusters.hpp).
    virtual void cluster_values(const Int3& lowest_base_cell, const ClusterPoints& points, ClusterValues& values,
                                unsigned worker) = 0;
    /// Unit vectors against the gradient; not-a-numbers where it vanishes.
    virtual void normals(const Int3& base_cell, PointList& points, const NormalRows& normals, unsigned worker) = 0;
    /// The numbers that a group of the particles' attributes has at the points. normals: unless none, what normals()
    /// gives. Returns at how many of the points no particle is near.
    virtual std::size_t attributes(const Int3& base_cell, PointList& points, const AttributeNumbers& numbers,
                                   unsigned group, const NormalRows* normals, GroupValues& values, unsigned worker) = 0;
};

}  // namespace meniscus::cpu
