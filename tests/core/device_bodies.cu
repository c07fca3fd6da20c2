// The stages' bodies are written once for CPU and GPU: that this compiles for a device, without warnings, is the test.
#include "field/sums.hpp"
#include "stages/adjust_levels.hpp"
#include "stages/count_triangles.hpp"
#include "stages/curvature.hpp"
#include "stages/emit_triangles.hpp"
#include "stages/fill_cracks.hpp"
#include "stages/place_vertices.hpp"
#include "stages/register_particles.hpp"
#include "stages/sample_field.hpp"
#include "stages/split_cells.hpp"

namespace meniscus {

__global__ void register_bodies(const Units3* positions, std::int64_t cell_units, ParticleKey* keys, float* out, Brick* bricks, float support, Int3 low, Int3 high) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    keys[i] = particle_key(positions[i], cell_units);
    key_position(keys[i], cell_units, out[3 * i], out[3 * i + 1], out[3 * i + 2]);
    mark_reached(bricks[0], out[3 * i], out[3 * i + 1], out[3 * i + 2], support);
    clear_beyond_domain(bricks[0], low, high);
    bricks[0].first = bricks[0].count();
}

__global__ void field_bodies(ParticleSetView set, CandidateView candidates, float* out) {
    const float x[1] = {out[0]}, y[1] = {out[1]}, z[1] = {out[2]};
    float value[1] = {0.0F};
    float bound = 0.0F, gx = 0.0F, gy = 0.0F, gz = 0.0F;
    sum_values<1>(candidates, x, y, z, value);
    float closest = 0.0F;
    sum_bounds(candidates, x[0], y[0], z[0], 8192.0F, bound, closest);
    const auto jet_at = [&](const Point3<float>& p) {
        FieldJet<float> jet;
        sum_jets(candidates, p.x, p.y, p.z, jet);
        return jet;
    };
    bound += closest + search_surface(CellCorners<float>{}, 1.0F, {0.0F, 0.0F, 0.0F}, 0.6F, jet_at).curvature;
    sum_gradients(candidates, x[0], y[0], z[0], gx, gy, gz);
    set.for_each_near({0, 0, 0}, {{0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F}}, [&](float px, float, float) { gx += px; });
    out[3] = value[0] + bound + gx + gy + gz;
}

__global__ void surface_bodies(BlocksView blocks, const std::uint32_t* counts, const CellBend* cells, const CubeCase* cubes, const CrackCase* cracks, Triangle* triangles,
                               Int3 low, Int3 high) {
    const std::uint32_t b = blockIdx.x * blockDim.x + threadIdx.x;
    if (b >= blocks.count) return;
    const CountCriterion criterion{counts, 1, false};
    const BandTest band{0.6F, 0.85F};
    const CurvatureCriterion bends{cells, 0.15F};
    const int level = band.is_deep(blocks.value(b, 0)) || band.may_reach(1.0F) ? criterion(blocks, b) : UniformCriterion{}(blocks, b);
    blocks.level[b] = static_cast<std::uint8_t>(level + bends(blocks, b) + BlobRule{}.least_level(0, {1.0F, 0.9F}) + misses_surface_on_face(blocks, b));
    blocks.sampled[b] = corner_points(blocks, b) | edge_middles(blocks, b) | half_edge_middles(blocks, b);
    blocks.inside[b] = domain_points(blocks.coordinate(b), low, high);
    if (joins_band(blocks, b)) blocks.level[b] = 3;
    const UsedEdges used(blocks, b);
    for (int axis = 0; axis < 3; ++axis) blocks.edges[b].axis[axis] = CrossedEdges(blocks, b, used, axis).finest();
    const EdgeValues ends = edge_values(SampledValues{blocks, b}, SampledValues{blocks, b}, 0, 0);
    blocks.samples[b] = ends.cropped(0.6F) ? cropped_offset(true, 6) : interpolated_offset(ends.low, ends.high, 0.6F, 6);
    blocks.slots[b] = {count_cell_triangles(blocks, b, cubes), count_crack_triangles(blocks, b, cracks)};
    emit_cell_triangles(blocks, b, cubes, triangles + blocks.slots[b].cells);
    emit_crack_triangles(blocks, b, cracks, triangles + blocks.slots[b].cracks);
}

__global__ void level_bodies(LevelSets levels, BaseVertexSets vertices, std::uint64_t* raised) {
    const std::uint32_t brick = blockIdx.x;
    const int w = static_cast<int>(threadIdx.x);
    const CornerSets corners(vertices, brick, w);
    raised[brick * Brick::words + threadIdx.x] = (corners.any_inside & ~corners.all_deep) | unbalanced_cells(levels, brick, w) | cells_to_promote(levels, brick, w) |
                                                 cells_with_corner_points(levels, brick, w) | cells_beside_finer(levels, brick, w);
}

}  // namespace meniscus
