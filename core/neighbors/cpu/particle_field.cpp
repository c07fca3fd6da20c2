// A block's points are summed by the way that fits their number: whole, alone, or pooled with other blocks'.
#include "neighbors/cpu/particle_field.hpp"

#include <cmath>

#include "neighbors/cpu/attribute_sums.hpp"
#include "neighbors/cpu/block_points.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "neighbors/cpu/point_sums.hpp"

namespace meniscus::cpu {
namespace {

/// The smallest box around points of a block.
UnitBox box_of(BlockMask points) {
    UnitBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const unsigned slabs = occupied_slabs(points, axis);
        box.low[axis] = static_cast<float>(lowest_bit(slabs) * units_per_cell);
        box.high[axis] = static_cast<float>(highest_bit(slabs) * units_per_cell);
    }
    return box;
}

/// Adds points of a block to a list. block: its place in blocks from the block that the list is relative to.
void list_block_points(BlockMask points, const Int3& block, PointList& list) {
    const float x = static_cast<float>(block.x) * base_edge, y = static_cast<float>(block.y) * base_edge,
                z = static_cast<float>(block.z) * base_edge;
    for (BlockMask left = points; left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        list.add(x + block_points.coordinate[0][bit], y + block_points.coordinate[1][bit],
                 z + block_points.coordinate[2][bit]);
    }
}

}  // namespace

template <class Kernel>
void ParticleField<Kernel>::values(const Int3& base_cell, PointList& points, float* values, unsigned worker) {
    pad(points);
    sum_points<Kernel>(search_.near_box(base_cell, box_of(points), worker), points, values);
}

template <class Kernel>
void ParticleField<Kernel>::cluster_values(const Int3& lowest_base_cell, const ClusterPoints& points,
                                           ClusterValues& values, unsigned worker) {
    // A block with few points would fill registers badly, and its own list of neighbors would cost more than it saves
    // (core/README.md#sampling-clusters-16-and-48).
    constexpr int few = 16;
    static_assert(few * cluster_blocks <= max_points);
    PointList pool;
    float* next = values.room;
    for (int i = 0; i < cluster_blocks; ++i) {
        const BlockMask own = points[static_cast<std::size_t>(i)];
        float*& out = values.of[static_cast<std::size_t>(i)];
        const int count = popcount(own);
        if (count <= few) {
            list_block_points(own, cluster_step(i), pool);
        } else if (own == ~BlockMask{0}) {
            whole_block_values(lowest_base_cell + cluster_step(i), out, worker);
        } else {
            out = next;
            block_values(lowest_base_cell + cluster_step(i), own, out, worker);
            next += count;
        }
    }
    if (pool.count == 0) return;
    pad(pool);
    sum_points<Kernel>(search_.near_box(lowest_base_cell, box_of(pool), worker), pool, next);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const int count = popcount(points[i]); count <= few) {
            values.of[i] = next;
            next += count;
        }
}

template <class Kernel>
void ParticleField<Kernel>::block_values(const Int3& base_cell, BlockMask points, float* values, unsigned worker) {
    // Above this number of points, the regular grid of all 64 costs less than a list of these.
    constexpr int most = 48;
    if (popcount(points) > most) {
        float whole[64];
        whole_block_values(base_cell, whole, worker);
        for (BlockMask left = points; left != 0; left &= left - 1) *values++ = whole[lowest_bit(left)];
        return;
    }
    PointList list;
    list_block_points(points, {0, 0, 0}, list);
    pad(list);
    sum_points<Kernel>(search_.near_box(base_cell, box_of(points), worker), list, values);
}

template <class Kernel>
void ParticleField<Kernel>::whole_block_values(const Int3& base_cell, float* values, unsigned worker) {
    constexpr float cell = units_per_cell;
    constexpr int rows = WideLanes::count / base_cell_size;  // rows along y in a register
    constexpr int registers = base_cell_size / rows;         // registers for a slab of the block
    const WideLanes x = WideLanes::load(block_points.coordinate[0]);
    WideLanes y[registers];
    for (int i = 0; i < registers; ++i) y[i] = WideLanes::load(block_points.coordinate[1] + i * WideLanes::count);
    // Fewer searches pay where a register holds a whole slab.
    constexpr int slabs = rows == base_cell_size ? 4 : 2;
    for (int slab = 0; slab < base_cell_size; slab += slabs) {
        float z[slabs];
        for (int k = 0; k < slabs; ++k) z[k] = static_cast<float>(slab + k) * cell;
        WideLanes sum[slabs * registers];
        for (WideLanes& s : sum) s = WideLanes(0.0F);
        for (const NeighborList& of_level :
             search_.near_box(base_cell, {{0.0F, 0.0F, z[0]}, {3 * cell, 3 * cell, z[slabs - 1]}}, worker))
            sum_grid_values<Kernel, registers, slabs>(of_level.view(), x, y, z, sum);
        for (int i = 0; i < slabs * registers; ++i) sum[i].store(values + (slab * registers + i) * WideLanes::count);
    }
}

template <class Kernel>
void ParticleField<Kernel>::normals(const Int3& base_cell, PointList& points, const NormalRows& normals,
                                    unsigned worker) {
    pad(points);
    const NeighborLists::Levels& near = search_.near_box(base_cell, box_of(points), worker);
    for_each_register(points, [&]<class F>(std::size_t i) {
        const F px = F::load(points.x + i), py = F::load(points.y + i), pz = F::load(points.z + i);
        const bool is_alone = points.count <= F::count;
        F gx(0.0F), gy(0.0F), gz(0.0F);
        for (const NeighborList& of_level : is_alone ? near : search_.nearer_box(box_of_lanes(px, py, pz), worker))
            sum_gradients<Kernel>(of_level.view(), px, py, pz, gx, gy, gz);
        turn_outward(gx, gy, gz);
        gx.store(normals.x + i);
        gy.store(normals.y + i);
        gz.store(normals.z + i);
    });
}

template <class Kernel>
std::size_t ParticleField<Kernel>::attributes(const Int3& base_cell, PointList& points, const AttributeNumbers& numbers,
                                              unsigned group, const NormalRows* normals, GroupValues& values,
                                              unsigned worker) {
    pad(points);
    const NeighborLists::Levels& near = search_.near_box_with_values(base_cell, box_of(points), group, worker);
    if (numbers.shape.are_ids(group)) {
        find_ids<Kernel>(near, points, values);
        return fill_gaps(base_cell, points, numbers, group, values);
    }
    const auto find = [&]<unsigned K>() {
        if (normals != nullptr)
            find_means<Kernel, K, true>(near, points, numbers.group(group), *normals, values);
        else
            find_means<Kernel, K, false>(near, points, numbers.group(group), {}, values);
    };
    switch (numbers.shape.count(group)) {
        case 1:
            find.template operator()<1>();
            break;
        case 2:
            find.template operator()<2>();
            break;
        case 3:
            find.template operator()<3>();
            break;
        default:
            find.template operator()<4>();
    }
    return fill_gaps(base_cell, points, numbers, group, values);
}

template <class Kernel>
std::size_t ParticleField<Kernel>::fill_gaps(const Int3& base_cell, const PointList& points,
                                             const AttributeNumbers& numbers, unsigned group,
                                             GroupValues& values) const {
    std::size_t lonely = 0;
    for (std::size_t i = 0; i < points.count; ++i) {
        if (values.weight[i] > 0.0F) continue;
        // The base cell of the point: a vertex lies nowhere on the upper faces of its own.
        const auto steps = [](float v) { return static_cast<int>(std::floor(v / base_edge)); };
        const Int3 step{steps(points.x[i]), steps(points.y[i]), steps(points.z[i])};
        const NearestParticle nearest = nearest_particle(
            base_cell + step, points.x[i] - static_cast<float>(step.x) * base_edge,
            points.y[i] - static_cast<float>(step.y) * base_edge, points.z[i] - static_cast<float>(step.z) * base_edge);
        if (!nearest.exists()) ++lonely;
        for (unsigned k = 0; k < numbers.shape.count(group); ++k) {
            const ParticleSet& set = search_.sets()[nearest.level];
            values.of[k][i] =
                nearest.exists()
                    ? numbers.group(group)[k].alone(set.values_of(group)[group_size_of_numbers * nearest.rank + k])
                    : numbers.group(group)[k].nothing();
        }
    }
    return lonely;
}

template <class Kernel>
NearestParticle ParticleField<Kernel>::nearest_particle(const Int3& base_cell, float x, float y, float z) const {
    NearestParticle nearest{x, y, z};
    for (unsigned k = 0; k < particle_level_count; ++k) {
        if (search_.sets()[k].count() == 0) continue;
        const ParticleSetView set = search_.sets()[k].view();
        const NeighborView all{set.x, set.y, set.z, set.weight, set.fall, 0, set.support, inverse_support(set.support)};
        set.for_each_near(base_cell_origin(base_cell), {{0.0F, 0.0F, 0.0F}, {base_edge, base_edge, base_edge}},
                          [&](float px, float py, float pz, std::uint32_t i) {
                              nearest.consider(Kernel::of(all, i), px, py, pz, k, i);
                          });
    }
    return nearest;
}

template class ParticleField<CubicSpline>;
template class ParticleField<Poly6>;

}  // namespace meniscus::cpu
