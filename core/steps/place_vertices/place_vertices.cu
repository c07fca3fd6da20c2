// Step 6 on the GPU: a warp for every cluster of blocks with vertices.
#include "steps/place_vertices/place_vertices.hpp"

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/particle_field.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/place_vertices/cluster_vertices.hpp"
#include "steps/place_vertices/coarse_edges.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) count_vertices(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    const BlocksView blocks = state.blocks();
    Counter total = 0;
    GridLoop{}.each_by_blocks(blocks.count, [&](std::uint32_t b, bool exists) {
        std::uint32_t count = 0;
        if (exists) {
            EdgeMasks edges{};
            if (state.corner_points[b] != 0) {
                const LevelsAround around = LevelsAround(blocks, b).within(state.settings.part, blocks.coordinate(b));
                for (int axis = 0; axis < 3; ++axis) edges.axis[axis] = CrossedEdges(blocks, b, around, axis).finest();
            }
            state.edges[b] = edges;
            count = static_cast<std::uint32_t>(edges.count());
            state.first_vertex[b] = count;
        }
        list_clusters(state, List::vertices, b, count != 0,
                      [&](auto* places, std::uint32_t n) { return counter.take_places(places, n); });
        total += count;
    });
    counter.add(&state.counts->needed[static_cast<int>(Resource::vertices)], total);
}

/// One thread: whether there is room for the mesh.
__global__ void require_room(const __grid_constant__ State state) {
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    for (const Resource r : {Resource::triangles, Resource::vertices})
        state.need(r, state.counts->needed[static_cast<int>(r)]);
}

/// A vertex of a block, and its place on its edge in steps of c / 2^bits.
struct Vertex {
    int axis, bit;
    float offset;

    /// The i-th of a block.
    __device__ Vertex(const EdgeMasks& edges, int i) : axis(0), bit(0), offset(0.0F) {
        BlockMask mask = edges.axis[0];
        for (int next = 1; next < 3; ++next) {
            const int count = popcount(mask);
            if (i < count) break;
            i -= count;
            mask = edges.axis[next];
            axis = next;
        }
        bit = nth_bit(mask, i);
    }
    /// The point in units from the block's corner.
    __device__ float coordinate(int along, float units_per_step) const {
        const auto low = static_cast<float>(point_coordinate(bit, along) * units_per_cell);
        return along == axis ? low + offset * units_per_step : low;
    }
};

/// One warp for every cluster with vertices, one lane for every vertex.
template <bool bisects, class Field>
__global__ void __launch_bounds__(block_threads, 2)
    place_listed(const __grid_constant__ State state, const Field field) {
    __shared__ typename Field::Shared shared[block_warps];
    __shared__ BlockCounter counter;
    const BlocksView blocks = state.blocks();
    const int bits = static_cast<int>(state.settings.offset_bits);
    const float iso = state.settings.iso;
    const auto units_per_step = static_cast<float>(units_per_cell >> bits);
    Counter evaluations = 0;
    each_listed_cluster(state, blocks, List::vertices, [&](const Cluster& cluster) {
        cluster.unmark(state);
        const ClusterVertices vertices(blocks, cluster);
        const std::uint32_t count = vertices.count;
        evaluations += static_cast<Counter>(count) * state.settings.bisection_steps;
        auto near = field.near(state, cluster, vertices.box, shared[warp_in_block()]);
        for (std::uint32_t first = 0; first < count; first += warp_threads) {
            const std::uint32_t i = first + lane_index();
            // Lanes without a vertex repeat the last one.
            const ClusterVertices::Place place = vertices.place(i < count ? i : count - 1);
            const EdgeMasks edges = blocks.edges[place.block];
            Vertex v(edges, place.i);
            const bool low_inside = (blocks.inside[place.block] >> v.bit & 1) != 0;
            const bool leaves = point_coordinate(v.bit, v.axis) == base_cell_size - 1;
            const EdgeValues ends = edge_values(
                SampledValues{blocks, place.block},
                SampledValues{blocks, leaves ? blocks.neighbor(place.block, axis_offset(v.axis)) : no_index}, v.axis,
                v.bit);
            const bool cropped = state.settings.has_domain && ends.cropped(iso);
            float x = 0.0F, y = 0.0F, z = 0.0F;
            UnitBox box;
            const auto go_to = [&](float offset) {
                v.offset = offset;
                x = v.coordinate(0, units_per_step) + static_cast<float>(place.step.x * units_per_base_cell);
                y = v.coordinate(1, units_per_step) + static_cast<float>(place.step.y * units_per_base_cell);
                z = v.coordinate(2, units_per_step) + static_cast<float>(place.step.z * units_per_base_cell);
                box = {{reduce_min(x), reduce_min(y), reduce_min(z)}, {reduce_max(x), reduce_max(y), reduce_max(z)}};
            };
            if constexpr (bisects) {
                go_to(bisection_start(bits));
                for (int step = first_bisection_step(bits); step >= 1; step /= 2) {
                    const float value = near.value(box, x, y, z);
                    go_to(bisected_offset(v.offset, step, value > iso, low_inside));
                }
            } else {
                const float shift =
                    state.settings.moves_coarse_vertices()
                        ? iso_shift(v.axis, v.bit,
                                    [&](int cell) {
                                        return CellAtEdge(blocks, state.bends,
                                                          blocks.neighbor(place.block, LevelsAround::offset(cell)));
                                    })
                        : 0.0F;
                go_to(cropped ? cropped_offset(low_inside, bits)
                              : interpolated_offset(ends.low, ends.high, iso + shift, bits));
            }
            if (i < count) state.vertices[place.number] = lattice_position(vertices.lowest, bits, x, y, z);
            if (!state.settings.has_normals) continue;
            const Normal normal = near.normal(box, x, y, z);
            if (i < count) state.normals[place.number] = outward_normal(normal, cropped, v.axis, low_inside);
        }
    });
    // All lanes of a warp have counted the same.
    if (bisects) counter.add(&state.counts->field_evaluations, lane_index() == 0 ? evaluations : Counter{0});
}

}  // namespace

template <class Field>
void place_vertices(const State& state, const Field& field, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch(blocks, block_threads, count_vertices, state);
    exclusive_sum(state.scratch_memory(), state.first_vertex, blocks + 1, launch.stream);
    launch(1, block_threads, require_room, state);
    auto* const place = state.settings.bisects ? place_listed<true, Field> : place_listed<false, Field>;
    launch.prefer_shared_memory(place);
    launch(blocks, block_warps, place, state, field);
    if (state.attributes.groups() != 0) place_attributes(state, field, launch);
}

template void place_vertices(const State&, const ParticleField<CubicSpline>&, const Launcher&);
template void place_vertices(const State&, const ParticleField<Poly6>&, const Launcher&);

}  // namespace meniscus::cuda
