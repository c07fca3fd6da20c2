// The field of a frame's particles, as kernels ask for it: all lanes of a warp together, for points of one cluster.
#pragma once

#include "engine/cuda/near_particles.hpp"
#include "engine/cuda/state.hpp"
#include "field/sums.hpp"

namespace meniscus::cuda {

/// Tests have another with the same members. A value is a pure function of the point's place in the world.
template <class Kernel>
struct ParticleField {
    using FieldKernel = Kernel;
    using Shared = NearParticles<Kernel>;                              ///< memory of a warp
    static constexpr bool has_own_supports = Kernel::has_own_support;  ///< which takes more registers

    /// The field in a part of a cluster. Points are in units from the corner of the cluster's lowest base cell; a box
    /// given with them holds those of all lanes.
    class Near {
    public:
        __device__ explicit Near(const ClusterParticles<Kernel>& particles) : particles_(particles) {}

        /// Values at G points of every lane.
        template <int G>
        __device__ void values(const UnitBox& box, const float (&x)[G], const float (&y)[G], const float (&z)[G],
                               float (&value)[G]) const {
            for (int g = 0; g < G; ++g) value[g] = 0.0F;
            particles_.for_each_near(box,
                                     [&](const OneCandidate& c) { sum_values<Kernel, G>(c.view(), x, y, z, value); });
        }
        /// At one point of every lane, or at two that differ in z.
        __device__ void column(const UnitBox& box, float x, float y, float z, float distance, bool are_two,
                               float (&value)[2]) const {
            const float upper = z + distance;
            value[0] = value[1] = 0.0F;
            particles_.for_each_piece(box, [&] {
                NearParticles<Kernel>& piece = particles_.piece();
                float one[1] = {value[0]};
                if (are_two)
                    piece.for_each_near(particles_.state(), box, [&](const OneCandidate& c) {
                        sum_values<Kernel, 2>(c.view(), {x, x}, {y, y}, {z, upper}, value);
                    });
                else
                    piece.for_each_near(particles_.state(), box, [&](const OneCandidate& c) {
                        sum_values<Kernel, 1>(c.view(), {x}, {y}, {z}, one);
                    });
                if (!are_two) value[0] = one[0];
            });
        }
        /// Unit vectors against the gradient at one point of every lane; not-a-numbers where it vanishes.
        __device__ Normal normal(const UnitBox& box, float x, float y, float z) const {
            float gx = 0.0F, gy = 0.0F, gz = 0.0F;
            particles_.for_each_near(
                box, [&](const OneCandidate& c) { sum_gradients<Kernel>(c.view(), x, y, z, gx, gy, gz); });
            turn_outward(gx, gy, gz);
            return {gx, gy, gz};
        }

    private:
        ClusterParticles<Kernel> particles_;
    };
    /// box: holds all points of the cluster that are asked for. brick: of base cells. lowest: base cell.
    __device__ Near near(const State& f, std::uint32_t brick, const Int3& lowest, const UnitBox& box,
                         Shared& shared) const {
        return Near(ClusterParticles<Kernel>(f, brick, lowest, box, shared));
    }
};

}  // namespace meniscus::cuda
