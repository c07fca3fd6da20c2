// The field of a frame's particles, as kernels ask for it: all lanes of a warp together, for points of one cluster.
#pragma once

#include "engine/cuda/state.hpp"
#include "field/sums.hpp"
#include "neighbors/cuda/cluster_neighbors.hpp"

namespace meniscus::cuda {

/// Tests have another with the same members. A value is a pure function of the point's place in the world.
template <class Kernel>
struct ParticleField {
    using FieldKernel = Kernel;
    using Shared = ClusterNeighbors<Kernel>;                           ///< shared memory of a warp
    static constexpr bool has_own_supports = Kernel::has_own_support;  ///< own supports take more registers

    /// The field in a part of a cluster. Points are in units from the cluster's corner; a box given with them holds
    /// those of all lanes.
    class Near {
    public:
        __device__ Near(const State& state, const Cluster& cluster, const UnitBox& box, Shared& shared)
            : state_(state), shared_(shared), neighbors_(state, cluster, box, shared) {}

        /// The value at one point of every lane.
        __device__ float value(const UnitBox& box, float x, float y, float z) {
            float value[1] = {0.0F};
            neighbors_.for_each_near(
                box, [&](const Neighbor& neighbor) { sum_values<Kernel, 1>(neighbor.view(), {x}, {y}, {z}, value); });
            return value[0];
        }
        /// The same, or values at two points that differ in z.
        __device__ void column(const UnitBox& box, float x, float y, float z, float upper_z, bool are_two,
                               float (&value)[2]) {
            float one[1] = {0.0F};
            float two[2] = {0.0F, 0.0F};
            neighbors_.for_each_piece(box, [&] {
                if (are_two)
                    shared_.for_each_near(state_, box, [&](const Neighbor& neighbor) {
                        sum_values<Kernel, 2>(neighbor.view(), {x, x}, {y, y}, {z, upper_z}, two);
                    });
                else
                    shared_.for_each_near(state_, box, [&](const Neighbor& neighbor) {
                        sum_values<Kernel, 1>(neighbor.view(), {x}, {y}, {z}, one);
                    });
            });
            value[0] = are_two ? two[0] : one[0];
            value[1] = two[1];
        }
        /// Unit vectors against the gradient at one point of every lane; not-a-numbers where it vanishes.
        __device__ Normal normal(const UnitBox& box, float x, float y, float z) {
            float gx = 0.0F, gy = 0.0F, gz = 0.0F;
            neighbors_.for_each_near(
                box, [&](const Neighbor& neighbor) { sum_gradients<Kernel>(neighbor.view(), x, y, z, gx, gy, gz); });
            turn_outward(gx, gy, gz);
            return {gx, gy, gz};
        }

    private:
        const State& state_;
        Shared& shared_;
        PartNeighbors<Kernel> neighbors_;
    };
    /// box: holds all points of the cluster that are asked for.
    __device__ Near near(const State& state, const Cluster& cluster, const UnitBox& box, Shared& shared) const {
        return {state, cluster, box, shared};
    }
};

}  // namespace meniscus::cuda
