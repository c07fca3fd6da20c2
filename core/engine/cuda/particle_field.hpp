// The field of a frame's particles, as kernels ask for it: all lanes of a warp together, for points that lie together.
#pragma once

#include "engine/cuda/candidates.hpp"
#include "engine/cuda/state.hpp"
#include "field/sums.hpp"

namespace meniscus::cuda {

/// Tests have another with the same members. Points are in units from a base cell's corner; `box` holds those of all
/// lanes. A value is a pure function of the point's place in the world. Staging: shared memory of a warp.
template <class Kernel>
struct ParticleField {
    using FieldKernel = Kernel;
    using Staging = ParticleStaging<Kernel>;
    static constexpr bool has_own_supports = Kernel::has_own_support;  ///< which takes more registers

    /// Values at G points of every lane.
    template <int G>
    __device__ void values(const State& f, const Int3& base_cell, const UnitBox& box, Staging& staging,
                           const float (&x)[G], const float (&y)[G], const float (&z)[G], float (&value)[G]) const {
        for (int g = 0; g < G; ++g) value[g] = 0.0F;
        for_each_staged_candidate<Kernel>(f, base_cell_origin(base_cell), box, staging, [&](const OneCandidate& c) {
            sum_values<Kernel, G>(c.view(), x, y, z, value);
        });
    }
    /// Unit vectors against the gradient at one point of every lane; not-a-numbers where it vanishes.
    __device__ Normal normal(const State& f, const Int3& base_cell, const UnitBox& box, Staging& staging, float x,
                             float y, float z) const {
        float gx = 0.0F, gy = 0.0F, gz = 0.0F;
        for_each_staged_candidate<Kernel>(f, base_cell_origin(base_cell), box, staging, [&](const OneCandidate& c) {
            sum_gradients<Kernel>(c.view(), x, y, z, gx, gy, gz);
        });
        turn_outward(gx, gy, gz);
        return {gx, gy, gz};
    }
};

}  // namespace meniscus::cuda
