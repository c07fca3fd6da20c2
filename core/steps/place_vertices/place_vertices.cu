#include "steps/place_vertices/place_vertices.hpp"

#include "engine/cuda/candidates.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) count_vertices(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    Counter total = 0;
    GridLoop{}.each_together(blocks.count, [&](std::uint32_t b, bool exists) {
        std::uint32_t count = 0;
        if (exists) {
            EdgeMasks edges{};
            if (f.corner_points[b] != 0) {
                const LevelsAround around(blocks, b);
                for (int axis = 0; axis < 3; ++axis) edges.axis[axis] = CrossedEdges(blocks, b, around, axis).finest();
            }
            f.edges[b] = edges;
            count = static_cast<std::uint32_t>(edges.count());
            f.first_vertex[b] = count;
        }
        const std::uint32_t at = take_places(&f.counts->listed[static_cast<int>(List::vertices)], count != 0 ? 1 : 0);
        if (count != 0) f.work[at] = b;
        total += count;
    });
    add_of_lanes(&f.counts->needed[static_cast<int>(Resource::vertices)], total);
}

/// One thread: where the levels' triangles begin, and whether there is room for the mesh.
__global__ void size_mesh(const __grid_constant__ Frame f) {
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    Counter total = 0;
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        f.counts->first_triangle[level] = static_cast<std::uint32_t>(total);
        total += f.counts->triangles[level];
    }
    f.need(Resource::triangles, total);
    f.need(Resource::vertices, f.counts->needed[static_cast<int>(Resource::vertices)]);
}

/// The ranges of a brick's triangles.
__global__ void __launch_bounds__(block_threads) describe_bricks(const __grid_constant__ Frame f) {
    const std::uint32_t bricks = f.count(Resource::bricks);
    const std::uint32_t blocks = f.count(Resource::blocks);
    GridLoop{}.each(bricks, [&](std::uint32_t b) {
        const LevelCounts begin = f.triangles_before[f.bricks[b].first];
        const LevelCounts end = f.triangles_before[b + 1 < bricks ? f.bricks[b + 1].first : blocks];
        const Int3 at = f.bricks[b].coordinate;
        MeshBrick brick;
        brick.coordinate = {at.x, at.y, at.z};
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            brick.ranges[level] = {f.counts->first_triangle[level] + begin.of[level], end.of[level] - begin.of[level]};
        f.mesh_bricks[b] = brick;
    });
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
    /// In units from the block's corner.
    __device__ float coordinate(int along, float units_per_step) const {
        const auto low = static_cast<float>(point_coordinate(bit, along) * units_per_cell);
        return along == axis ? low + offset * units_per_step : low;
    }
};

/// One warp for every block with vertices, one lane for every vertex.
template <bool bisects>
__global__ void __launch_bounds__(block_threads, 2) place_listed(const __grid_constant__ Frame f) {
    __shared__ Staging staging[block_warps];
    const BlocksView blocks = f.blocks();
    const int bits = static_cast<int>(f.settings.offset_bits);
    const float iso = f.settings.iso;
    const auto units_per_step = static_cast<float>(units_per_cell >> bits);
    Counter evaluations = 0;
    each_by_warp(f.listed(List::vertices), [&](std::uint32_t entry) {
        const std::uint32_t block = f.work[entry];
        const EdgeMasks edges = blocks.edges[block];
        const Int3 at = blocks.coordinate(block);
        const Units3 origin = base_cell_origin(at);
        const int count = edges.count();
        evaluations += static_cast<Counter>(count) * f.bisection_steps;
        for (int first = 0; first < count; first += static_cast<int>(warp_threads)) {
            const int i = first + static_cast<int>(lane_index());
            // Lanes without a vertex repeat the last one.
            Vertex v(edges, i < count ? i : count - 1);
            const bool low_inside = (blocks.inside[block] >> v.bit & 1) != 0;
            const EdgeValues ends =
                edge_values(SampledValues{blocks, block},
                            SampledValues{blocks, blocks.neighbor(block, axis_offset(v.axis))}, v.axis, v.bit);
            const bool cropped = f.settings.has_domain && ends.cropped(iso);
            float x = 0.0F, y = 0.0F, z = 0.0F;
            UnitBox box;
            const auto go_to = [&](float offset) {
                v.offset = offset;
                x = v.coordinate(0, units_per_step);
                y = v.coordinate(1, units_per_step);
                z = v.coordinate(2, units_per_step);
                box = {{reduce_min(x), reduce_min(y), reduce_min(z)}, {reduce_max(x), reduce_max(y), reduce_max(z)}};
            };
            if constexpr (bisects) {
                // The paper's bisection: every step moves to the middle of the half that still has a change of sign.
                const int whole = 1 << bits;
                go_to(static_cast<float>(whole / 2));
                for (int half = whole / 4; half >= 1; half /= 2) {
                    const float px[1] = {x}, py[1] = {y}, pz[1] = {z};
                    float sum[1] = {0.0F};
                    for_each_staged_candidate(f, origin, box, staging[warp_in_block()],
                                              [&](const OneCandidate& c) { sum_values<1>(c.view(), px, py, pz, sum); });
                    go_to(v.offset + static_cast<float>((sum[0] > iso) == low_inside ? half : -half));
                }
            } else {
                go_to(cropped ? cropped_offset(low_inside, bits) : interpolated_offset(ends.low, ends.high, iso, bits));
            }
            const std::uint32_t number = blocks.first_vertex[block] + static_cast<std::uint32_t>(i);
            if (i < count) {
                const int steps = base_cell_size << bits;
                const float steps_per_unit = 1.0F / units_per_step;
                f.vertices[number] = {at.x * steps + static_cast<int>(x * steps_per_unit),
                                      at.y * steps + static_cast<int>(y * steps_per_unit),
                                      at.z * steps + static_cast<int>(z * steps_per_unit)};
            }
            if (!f.has_normals) continue;
            float gx = 0.0F, gy = 0.0F, gz = 0.0F;
            for_each_staged_candidate(f, origin, box, staging[warp_in_block()],
                                      [&](const OneCandidate& c) { sum_gradients(c.view(), x, y, z, gx, gy, gz); });
            turn_outward(gx, gy, gz);
            if (i < count) f.normals[number] = outward_normal({gx, gy, gz}, cropped, v.axis, low_inside);
        }
    });
    if (bisects && lane_index() == 0 && evaluations != 0) atomicAdd(&f.counts->field_evaluations, evaluations);
}

}  // namespace

void place_vertices(const Frame& frame, const Launcher& launch) {
    const std::uint64_t blocks = frame.capacity[Resource::blocks];
    launch(blocks, block_threads, count_vertices, frame);
    exclusive_sum(frame.scratch_memory(), frame.first_vertex, blocks + 1, launch.stream);
    launch(1, block_threads, size_mesh, frame);
    launch(frame.capacity[Resource::bricks], block_threads, describe_bricks, frame);
    launch(blocks, block_warps, frame.bisects ? place_listed<true> : place_listed<false>, frame);
}

}  // namespace meniscus::cuda
