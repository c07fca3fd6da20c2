// Base vertices are sampled for all stored cells, before the band is known.
#include "engine/cuda/candidates.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus::cuda {
namespace {

/// One thread for every block: base vertices lie as far apart as particles, so that few of them share any.
template <class Kernel>
__global__ void __launch_bounds__(block_threads, 3) sample_base(const __grid_constant__ State f) {
    const BlocksView blocks = f.blocks();
    // What is sampled later is appended.
    if (blockIdx.x == 0 && threadIdx.x == 0) {
        f.need(Resource::samples, blocks.count);
        f.counts->field_evaluations = blocks.count;
    }
    const std::uint32_t count = blocks.count <= f.capacity[Resource::samples] ? blocks.count : 0;
    LongLoop loop(f);
    GridLoop{}.each(count, [&](std::uint32_t b) {
        if (!loop.goes_on()) return;
        const Int3 at = blocks.coordinate(b);
        constexpr float edge = units_per_base_cell;
        const float zero[1] = {0.0F};
        float value[1] = {0.0F};
        float bound = 0.0F;
        float closest = 0.0F;
        for_each_candidate<Kernel>(
            f, base_cell_origin(at), {{0.0F, 0.0F, 0.0F}, {edge, edge, edge}}, [&](const OneCandidate& c) {
                sum_values<Kernel, 1>(c.view(), zero, zero, zero, value);
                sum_bounds<Kernel>(c.view(), edge / 2, edge / 2, edge / 2, edge / 2, bound, closest);
            });
        const bool allowed =
            !f.settings.has_domain || (domain_points(at, f.settings.domain_low, f.settings.domain_high) & 1) != 0;
        f.samples[b] = value[0];
        f.reaches[b] = {bound, closest};
        f.first_sample[b] = b;
        f.sampled[b] = 1;
        f.inside[b] = allowed && value[0] > f.settings.iso ? 1 : 0;
    });
}

}  // namespace

void sample_base_vertices(const State& state, const Launcher& launch) {
    with_kernel(state.settings, [&]<class Kernel>() {
        launch(state.capacity[Resource::blocks], block_threads, sample_base<Kernel>, state);
    });
}

}  // namespace meniscus::cuda
