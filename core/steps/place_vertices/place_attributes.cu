// Attributes of the vertices, once those have their places: a warp for every cluster of blocks with vertices. A kernel
// of its own, so that those of frames without attributes keep their registers.
#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/warp.hpp"
#include "field/cubic_spline.hpp"
#include "field/poly6.hpp"
#include "neighbors/cuda/cluster_neighbors.hpp"
#include "neighbors/cuda/neighbor.hpp"
#include "neighbors/cuda/particle_field.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/place_vertices/cluster_vertices.hpp"

namespace meniscus::cuda {
namespace {

/// The numbers of a group at a vertex. weight: the sum of the particles' shares there, or for ids the largest share.
struct VertexValues {
    float of[group_size_of_numbers];
    float weight;
};

/// Means of the first K numbers of a group at one point of every lane; not-a-numbers where the weight is 0.
template <class Kernel, unsigned K>
__device__ void find_means(PartNeighbors<Kernel, true>& near, const UnitBox& box, const float4* numbers,
                           const AttributeNumber* of_group, float x, float y, float z, VertexValues& values) {
    float sum[K] = {};
    values.weight = 0.0F;
    near.for_each_near(box, [&](const Neighbor& neighbor) {
        const float4 own = numbers[neighbor.rank];
        const float of_particle[group_size_of_numbers] = {own.x, own.y, own.z, own.w};
        float none = 0.0F;
        sum_numbers<Kernel, K, false>(neighbor.view(), of_particle, x, y, z, none, none, none, values.weight, sum);
    });
    for (unsigned k = 0; k < K; ++k) values.of[k] = of_group[k].mean(sum[k], values.weight);
}

/// Ids of the particle with the largest share at one point of every lane.
template <class Kernel>
__device__ void find_ids(PartNeighbors<Kernel, true>& near, const UnitBox& box, const float4* numbers, float x, float y,
                         float z, VertexValues& values) {
    LargestShare largest;
    near.for_each_near(box, [&](const Neighbor& neighbor) {
        const float4 own = numbers[neighbor.rank];
        const float of_particle[group_size_of_numbers] = {own.x, own.y, own.z, own.w};
        largest.add(Kernel::of(neighbor.view(), 0)
                        .share(x - neighbor.particle.x, y - neighbor.particle.y, z - neighbor.particle.z),
                    of_particle);
    });
    values.weight = largest.share;
    for (unsigned k = 0; k < group_size_of_numbers; ++k) values.of[k] = AttributeNumber::as_float(largest.ids[k]);
}

/// A name without a comma, which a declaration of shared memory may not have here.
template <class Kernel>
using SharedParticles = ClusterNeighbors<Kernel, true>;

/// K: amounts in the group, or 0 for a group of ids.
template <class Kernel, unsigned K>
__global__ void __launch_bounds__(block_threads) place_group(const __grid_constant__ State state, unsigned group) {
    __shared__ SharedParticles<Kernel> shared[block_warps];
    __shared__ BlockCounter counter;
    const BlocksView blocks = state.blocks();
    const float units_per_step = static_cast<float>(units_per_cell >> state.settings.offset_bits);
    const int steps_per_base_cell = base_cell_size << state.settings.offset_bits;
    const AttributeNumber* const group_numbers = state.input->attributes.group(group);
    const unsigned count_of_numbers = state.attributes.count(group);
    const float4* const numbers = state.numbers + group * state.capacity.particles;
    Counter lonely = 0;
    each_listed_cluster(state, blocks, List::vertices, [&](const Cluster& cluster) {
        const ClusterVertices vertices(blocks, cluster);
        const Int3 lowest = vertices.lowest;
        PartNeighbors<Kernel, true> near(state, cluster, vertices.box, shared[warp_in_block()]);
        const std::uint32_t count = vertices.count;
        for (std::uint32_t first = 0; first < count; first += warp_threads) {
            const std::uint32_t i = first + lane_index();
            // Lanes without a vertex repeat the last one.
            const ClusterVertices::Place place = vertices.place(i < count ? i : count - 1);
            const LatticePosition p = state.vertices[place.number];
            const float x = static_cast<float>(p[0] - lowest.x * steps_per_base_cell) * units_per_step;
            const float y = static_cast<float>(p[1] - lowest.y * steps_per_base_cell) * units_per_step;
            const float z = static_cast<float>(p[2] - lowest.z * steps_per_base_cell) * units_per_step;
            const UnitBox box{{reduce_min(x), reduce_min(y), reduce_min(z)},
                              {reduce_max(x), reduce_max(y), reduce_max(z)}};
            VertexValues values{};
            if constexpr (K == 0)
                find_ids<Kernel>(near, box, numbers, x, y, z, values);
            else
                find_means<Kernel, K>(near, box, numbers, group_numbers, x, y, z, values);
            if (i >= count) continue;
            if (!(values.weight > 0.0F)) {
                const Int3& step = place.step;
                NearestParticle nearest{x - static_cast<float>(step.x * units_per_base_cell),
                                        y - static_cast<float>(step.y * units_per_base_cell),
                                        z - static_cast<float>(step.z * units_per_base_cell)};
                for_each_neighbor<Kernel>(
                    state, base_cell_origin(lowest + step), {{0.0F, 0.0F, 0.0F}, {base_edge, base_edge, base_edge}},
                    [&](const Neighbor& neighbor) {
                        nearest.consider(Kernel::of(neighbor.view(), 0), neighbor.particle.x, neighbor.particle.y,
                                         neighbor.particle.z, 0, neighbor.rank);
                    });
                if (!nearest.exists()) ++lonely;
                const float4 own = nearest.exists() ? numbers[nearest.rank] : float4{0.0F, 0.0F, 0.0F, 0.0F};
                const float of_particle[group_size_of_numbers] = {own.x, own.y, own.z, own.w};
                for (unsigned k = 0; k < count_of_numbers; ++k)
                    values.of[k] =
                        nearest.exists() ? group_numbers[k].alone(of_particle[k]) : group_numbers[k].nothing();
            }
            for (unsigned k = 0; k < count_of_numbers; ++k)
                group_numbers[k].write(state.vertex_attributes[group_numbers[k].array], place.number, values.of + k, 1);
        }
    });
    if (group == 0) counter.add(&state.counts->vertices_without_particles, lonely);
}

}  // namespace

template <class Field>
void place_attributes(const State& state, const Field&, const Launcher& launch) {
    using Kernel = typename Field::FieldKernel;
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    for (unsigned group = 0; group < state.attributes.groups(); ++group) {
        const auto place = [&](auto* kernel) { launch(blocks, block_warps, kernel, state, group); };
        if (state.attributes.are_ids(group)) {
            place(place_group<Kernel, 0>);
            continue;
        }
        switch (state.attributes.count(group)) {
            case 1:
                place(place_group<Kernel, 1>);
                break;
            case 2:
                place(place_group<Kernel, 2>);
                break;
            case 3:
                place(place_group<Kernel, 3>);
                break;
            default:
                place(place_group<Kernel, 4>);
        }
    }
}

template void place_attributes(const State&, const ParticleField<CubicSpline>&, const Launcher&);
template void place_attributes(const State&, const ParticleField<Poly6>&, const Launcher&);

}  // namespace meniscus::cuda
