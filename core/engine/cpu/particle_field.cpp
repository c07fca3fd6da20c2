#include "engine/cpu/particle_field.hpp"

#include <algorithm>
#include <atomic>

#include "engine/cpu/block_points.hpp"
#include "engine/cpu/clusters.hpp"
#include "field/sums.hpp"
#include "steps/sample_field/sample_field.hpp"
#include "steps/split_cells/curvature.hpp"

namespace meniscus::cpu {
namespace {

constexpr float base_edge = units_per_base_cell;

/// The smallest box around padded points.
UnitBox box_of(const PointList& points) {
    UnitBox box;
    const float* coordinates[3] = {points.x, points.y, points.z};
    for (int axis = 0; axis < 3; ++axis) {
        Lanes low = Lanes::load(coordinates[axis]);
        Lanes high = low;
        for (std::size_t i = Lanes::count; i < points.count; i += Lanes::count) {
            low = min(low, Lanes::load(coordinates[axis] + i));
            high = max(high, Lanes::load(coordinates[axis] + i));
        }
        box.low[axis] = reduce_min(low);
        box.high[axis] = reduce_max(high);
    }
    return box;
}

/// The smallest box around eight points.
UnitBox box_of(const Point3<Lanes>& points) {
    return {{reduce_min(points.x), reduce_min(points.y), reduce_min(points.z)},
            {reduce_max(points.x), reduce_max(points.y), reduce_max(points.z)}};
}

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

/// Lanes beyond the last point repeat it.
void pad(PointList& points) {
    for (std::size_t i = points.count; i % Lanes::count != 0; ++i) {
        points.x[i] = points.x[points.count - 1];
        points.y[i] = points.y[points.count - 1];
        points.z[i] = points.z[points.count - 1];
    }
}

/// Adds points of a block that lies so many blocks from the list's.
void list_block_points(BlockMask points, const Int3& block, PointList& list) {
    const float x = static_cast<float>(block.x) * base_edge, y = static_cast<float>(block.y) * base_edge,
                z = static_cast<float>(block.z) * base_edge;
    for (BlockMask left = points; left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        list.add(x + block_points.coordinate[0][bit], y + block_points.coordinate[1][bit],
                 z + block_points.coordinate[2][bit]);
    }
}

/// Spreads values in the order of some points to the places of their bits; returns where the values end.
const float* scatter(BlockMask points, const float* values, float* by_bit) {
    for (BlockMask left = points; left != 0; left &= left - 1) by_bit[lowest_bit(left)] = *values++;
    return values;
}

/// Values at G registers of points from the i-th on.
template <int G>
void sum_group(const CandidateLists::Levels& near, const PointList& points, std::size_t i, float* out) {
    Lanes x[G], y[G], z[G], sum[G];
    for (int g = 0; g < G; ++g) {
        const std::size_t at = i + static_cast<std::size_t>(g) * Lanes::count;
        x[g] = Lanes::load(points.x + at);
        y[g] = Lanes::load(points.y + at);
        z[g] = Lanes::load(points.z + at);
        sum[g] = Lanes(0.0F);
    }
    for (const Candidates& c : near) sum_values<G>(c.view(), x, y, z, sum);
    for (int g = 0; g < G; ++g) sum[g].store(out + i + static_cast<std::size_t>(g) * Lanes::count);
}

void sum_points(const CandidateLists::Levels& near, const PointList& points, float* out) {
    std::size_t i = 0;
    for (; points.count > i + Lanes::count; i += 2 * Lanes::count) sum_group<2>(near, points, i, out);
    if (points.count > i) sum_group<1>(near, points, i, out);
}

}  // namespace

ParticleField::ParticleField(const std::shared_ptr<MemoryAccount>& account, Workers& workers, ParticleSets& sets)
    : workers_(workers), sets_(sets) {
    for (unsigned i = 0; i < workers.count(); ++i) lists_.emplace_back(account);
}

const CandidateLists::Levels& ParticleField::near_cluster(const Int3& base_cell, unsigned worker) {
    CandidateLists& lists = lists_[worker];
    const Int3 corner{base_cell.x & ~1, base_cell.y & ~1, base_cell.z & ~1};
    if (!lists.has_cluster || !(lists.corner == corner)) {
        const UnitBox box{{0.0F, 0.0F, 0.0F}, {2 * base_edge, 2 * base_edge, 2 * base_edge}};
        for (std::size_t k = 0; k < particle_level_count; ++k)
            lists.cluster[k].gather(sets_[k].view(), base_cell_origin(corner), box);
        lists.corner = corner;
        lists.has_cluster = true;
    }
    return lists.cluster;
}

const CandidateLists::Levels& ParticleField::near_box(const Int3& base_cell, const UnitBox& box, unsigned worker) {
    const CandidateLists::Levels& cluster = near_cluster(base_cell, worker);
    CandidateLists& lists = lists_[worker];
    const Int3 offset = base_cell - lists.corner;
    const std::array<float, 3> shift{static_cast<float>(-offset.x) * base_edge,
                                     static_cast<float>(-offset.y) * base_edge,
                                     static_cast<float>(-offset.z) * base_edge};
    for (std::size_t k = 0; k < particle_level_count; ++k) lists.near[k].cull(cluster[k], shift, box);
    return lists.near;
}

void ParticleField::even_out_lists() {
    for (const auto levels : {&CandidateLists::cluster, &CandidateLists::near})
        for (std::size_t k = 0; k < particle_level_count; ++k) {
            std::size_t most = 0;
            for (const CandidateLists& lists : lists_) most = std::max(most, (lists.*levels)[k].capacity());
            for (CandidateLists& lists : lists_) (lists.*levels)[k].reserve(most);
        }
}

void ParticleField::begin_frame(Field field) {
    for (CandidateLists& lists : lists_) lists.has_cluster = false;
    if (field != Field::color) return;
    divide_weights_by_density();
    for (CandidateLists& lists : lists_) lists.has_cluster = false;
}

void ParticleField::find_densities(ParticleSet& set, const Brick& brick, unsigned worker) {
    CandidateLists::Levels& near = lists_[worker].near;
    // The middle of the brick: float32 then holds the coordinates of all that is near it.
    const std::int64_t half = set.cell_units * brick_size / 2;
    const auto middle = static_cast<float>(half);
    const Units3 origin{(2 * brick.coordinate.x + 1) * half, (2 * brick.coordinate.y + 1) * half,
                        (2 * brick.coordinate.z + 1) * half};
    PointList points;
    alignas(32) float out[2 * Lanes::count];
    // Particles in a row of cells follow one another: they fill the lanes whatever cells they are in.
    brick.for_each_run({0, 0, 0}, {brick_size - 1, brick_size - 1, brick_size - 1},
                       [&](std::uint32_t cell, std::uint32_t count) {
                           const std::uint32_t end = set.first[cell + count];
                           for (std::uint32_t begin = set.first[cell]; begin < end; begin += 2 * Lanes::count) {
                               points.count = 0;
                               for (std::uint32_t i = begin; i < end && points.count < 2 * Lanes::count; ++i)
                                   points.add(set.x[i] - middle, set.y[i] - middle, set.z[i] - middle);
                               pad(points);
                               for (std::size_t j = 0; j < particle_level_count; ++j)
                                   near[j].gather(sets_[j].view(), origin, box_of(points));
                               sum_points(near, points, out);
                               std::copy(out, out + points.count, set.densities.begin() + begin);
                           }
                       });
}

void ParticleField::divide_weights_by_density() {
    // A density is a sum of the weights that it will divide: all are computed before any is.
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets_[k];
        resize_for_overwrite(set.densities, set.count());
        workers_.for_ranges(set.cells.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
            for (std::size_t b = begin; b < end; ++b) find_densities(set, set.cells.bricks[b], worker);
        });
    }
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets_[k];
        workers_.for_ranges(set.count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) set.weight[i] /= set.densities[i];
        });
    }
    even_out_lists();
}

void ParticleField::sample_base_vertices(Surface& s, Array<CellReach>& reaches) {
    resize_for_overwrite(reaches, s.block_count());
    s.samples.reserve(s.block_count());
    s.samples.resize(s.block_count());
    // Base vertices of 2 x 2 x 2 cells fill the lanes; their cells' bounds need the same particles.
    alignas(32) float lane_x[8], lane_y[8], lane_z[8];
    for (int i = 0; i < 8; ++i) {
        lane_x[i] = static_cast<float>(i & 1) * base_edge;
        lane_y[i] = static_cast<float>(i >> 1 & 1) * base_edge;
        lane_z[i] = static_cast<float>(i >> 2) * base_edge;
    }
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        const Lanes x[1] = {Lanes::load(lane_x)}, y[1] = {Lanes::load(lane_y)}, z[1] = {Lanes::load(lane_z)};
        const Lanes half(base_edge / 2);
        alignas(32) float value[8], bound[8], closest[8];
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            for_each_cluster(brick.occupied, [&](const Int3& corner) {
                const Int3 base = brick.corner() + corner;
                Lanes sum[1] = {Lanes(0.0F)};
                Lanes most(0.0F), nearest(0.0F);
                for (const Candidates& c : near_cluster(base, worker)) {
                    sum_values<1>(c.view(), x, y, z, sum);
                    sum_bounds(c.view(), x[0] + half, y[0] + half, z[0] + half, base_edge / 2, most, nearest);
                }
                sum[0].store(value);
                most.store(bound);
                nearest.store(closest);
                for (int i = 0; i < 8; ++i) {
                    const Int3 step{i & 1, i >> 1 & 1, i >> 2};
                    const int place = index_in_brick(corner + step);
                    if (!brick.holds(place)) continue;
                    const std::uint32_t block = brick.number(place);
                    s.samples[block] = value[i];
                    reaches[block] = {bound[i], closest[i]};
                    s.first_sample[block] = block;
                    s.sampled[block] = 1;
                    const bool allowed =
                        !s.settings.has_domain ||
                        (domain_points(base + step, s.settings.domain_low, s.settings.domain_high) & 1) != 0;
                    s.inside[block] = allowed && value[i] > s.settings.iso ? 1 : 0;
                }
            });
        }
    });
    s.field_evaluations += s.block_count();
    even_out_lists();
}

void ParticleField::measure_bends(Surface& s, const Array<CellReach>& reaches, Array<CellBend>& bends) {
    resize_for_overwrite(bends, s.block_count());
    const BlocksView blocks = s.view();
    const BlobRule blobs{s.settings.blob_closest, s.settings.blob_level};
    const float iso = s.settings.iso;
    std::atomic<std::uint64_t> evaluations{0};
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            for_each_cluster(brick.occupied, [&](const Int3& corner) {
                std::uint32_t block[8];
                std::uint64_t cells = 0;
                int first = 0;
                for (int i = 0; i < 8; ++i) {
                    const int place = index_in_brick(corner + cluster_step(i));
                    block[i] = brick.holds(place) ? brick.number(place) : no_index;
                    if (block[i] != no_index) bends[block[i]] = {0.0F, 1};
                    const bool in_band = blocks.level_or_none(block[i]) != 0;
                    if (in_band && cells++ == 0) first = i;
                    if (!in_band) block[i] = no_index;
                }
                if (cells == 0) return;
                // The cells share their corners: x + 3 y + 9 z.
                float vertices[27];
                unsigned inside_vertices = 0;
                for (int i = 0; i < 27; ++i) {
                    const std::uint32_t owner = blocks.grid.neighbor(static_cast<std::uint32_t>(b),
                                                                     index_in_brick(corner), {i % 3, i / 3 % 3, i / 9});
                    vertices[i] = (owner == no_index ? 0.0F : blocks.value(owner, 0)) - iso;
                    inside_vertices |= static_cast<unsigned>(blocks.inside_or_none(owner) & 1) << i;
                }
                alignas(32) float corners[8][8], starts[3][8], mixed[8];  // [corner][cell]
                int inside_corners[8];
                for (int i = 0; i < 8; ++i) {
                    // Lanes of cells outside the band repeat another's, so that the box around their points stays
                    // small.
                    const Int3 step = cluster_step(block[i] != no_index ? i : first);
                    inside_corners[i] = 0;
                    for (int k = 0; k < 8; ++k) {
                        const int vertex = step.x + (k & 1) + 3 * (step.y + (k >> 1 & 1)) + 9 * (step.z + (k >> 2));
                        corners[k][i] = vertices[vertex];
                        inside_corners[i] += static_cast<int>(inside_vertices >> vertex & 1);
                    }
                    mixed[i] = is_mixed(inside_corners[i]) ? 1.0F : 0.0F;
                    starts[0][i] = static_cast<float>(step.x) * base_edge;
                    starts[1][i] = static_cast<float>(step.y) * base_edge;
                    starts[2][i] = static_cast<float>(step.z) * base_edge;
                }
                evaluations.fetch_add(2 * cells, std::memory_order_relaxed);
                const Int3 base = brick.corner() + corner;
                const auto jet_at = [&](const Point3<Lanes>& p) {
                    FieldJet<Lanes> jet;
                    for (const Candidates& c : near_box(base, box_of(p), worker))
                        sum_jets(c.view(), p.x, p.y, p.z, jet);
                    return jet;
                };
                CellCorners<Lanes> values;
                for (int k = 0; k < 8; ++k) values.value[k] = Lanes::load(corners[k]);
                const Point3<Lanes> origin{Lanes::load(starts[0]), Lanes::load(starts[1]), Lanes::load(starts[2])};
                const SurfaceSearch<Lanes> search = search_surface(values, Lanes::load(mixed), origin, iso, jet_at);
                alignas(32) float curvature[8], inside[8];
                search.curvature.store(curvature);
                search.inside.store(inside);
                for (int i = 0; i < 8; ++i) {
                    if (block[i] == no_index) continue;
                    bends[block[i]] = cell_bend({curvature[i], inside[i]}, inside_corners[i],
                                                blobs.least_level(inside_corners[i], reaches[block[i]]));
                }
            });
        }
    });
    s.field_evaluations += evaluations.load(std::memory_order_relaxed);
    even_out_lists();
}

void ParticleField::values(const Int3& base_cell, PointList& points, float* values, unsigned worker) {
    pad(points);
    sum_points(near_box(base_cell, box_of(points), worker), points, values);
}

void ParticleField::cluster_values(const Int3& lowest_base_cell, const ClusterPoints& points, ClusterValues& values,
                                   unsigned worker) {
    // A block with few points would fill registers badly, and its own list of particles would cost more than it saves.
    constexpr int few = 2 * Lanes::count;
    // With so many, the grid's regularity saves more than the points left out.
    constexpr int most = 48;
    PointList pool;
    for (int i = 0; i < 8; ++i) {
        const BlockMask own = points[static_cast<std::size_t>(i)];
        const int count = popcount(own);
        if (count <= few) {
            list_block_points(own, cluster_step(i), pool);
        } else {
            float* const out = values[static_cast<std::size_t>(i)].data();
            if (count > most)
                whole_block_values(lowest_base_cell + cluster_step(i), out, worker);
            else
                block_values(lowest_base_cell + cluster_step(i), own, out, worker);
        }
    }
    if (pool.count == 0) return;
    pad(pool);
    alignas(32) float sums[max_points];
    sum_points(near_box(lowest_base_cell, box_of(pool), worker), pool, sums);
    const float* next = sums;
    for (std::size_t i = 0; i < 8; ++i)
        if (popcount(points[i]) <= few) next = scatter(points[i], next, values[i].data());
}

void ParticleField::block_values(const Int3& base_cell, BlockMask points, float* values, unsigned worker) {
    PointList list;
    list_block_points(points, {0, 0, 0}, list);
    pad(list);
    alignas(32) float sums[max_points];
    sum_points(near_box(base_cell, box_of(points), worker), list, sums);
    scatter(points, sums, values);
}

void ParticleField::whole_block_values(const Int3& base_cell, float* values, unsigned worker) {
    constexpr float cell = units_per_cell;
    static constexpr float row_x[8] = {0, cell, 2 * cell, 3 * cell, 0, cell, 2 * cell, 3 * cell};
    static constexpr float row_y[8] = {0, 0, 0, 0, cell, cell, cell, cell};
    const Lanes x = Lanes::load(row_x);
    const Lanes y[2] = {Lanes::load(row_y), Lanes::load(row_y) + Lanes(2 * cell)};
    // Each half of the block has so much fewer particles near it that a search of its own pays.
    for (int slab = 0; slab < base_cell_size; slab += 2) {
        const float low = static_cast<float>(slab) * cell;
        const float z[2] = {low, low + cell};
        Lanes sum[4] = {Lanes(0.0F), Lanes(0.0F), Lanes(0.0F), Lanes(0.0F)};
        for (const Candidates& c : near_box(base_cell, {{0.0F, 0.0F, z[0]}, {3 * cell, 3 * cell, z[1]}}, worker))
            sum_grid_values<2, 2>(c.view(), x, y, z, sum);
        for (int i = 0; i < 4; ++i) sum[i].store(values + (2 * slab + i) * Lanes::count);
    }
}

void ParticleField::normals(const Int3& base_cell, PointList& points, float* x, float* y, float* z, unsigned worker) {
    pad(points);
    const CandidateLists::Levels& near = near_box(base_cell, box_of(points), worker);
    for (std::size_t i = 0; i < points.count; i += Lanes::count) {
        const Lanes px = Lanes::load(points.x + i), py = Lanes::load(points.y + i), pz = Lanes::load(points.z + i);
        Lanes gx(0.0F), gy(0.0F), gz(0.0F);
        for (const Candidates& c : near) sum_gradients(c.view(), px, py, pz, gx, gy, gz);
        turn_outward(gx, gy, gz);
        gx.store(x + i);
        gy.store(y + i);
        gz.store(z + i);
    }
}

}  // namespace meniscus::cpu
