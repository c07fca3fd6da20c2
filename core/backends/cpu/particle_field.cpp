#include "backends/cpu/particle_field.hpp"

#include <algorithm>

#include "field/sums.hpp"

namespace meniscus::cpu {
namespace {

CandidateView view(const Candidates& c) {
    return {c.x.data(), c.y.data(), c.z.data(), c.weight.data(), c.count, c.inverse_support};
}

/// The smallest box around points, padding lanes excluded.
UnitBox box_of(const PointList& points) {
    UnitBox box{{points.x[0], points.y[0], points.z[0]}, {points.x[0], points.y[0], points.z[0]}};
    const float* coordinates[3] = {points.x, points.y, points.z};
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t i = 1; i < points.count; ++i) {
            box.low[axis] = std::min(box.low[axis], coordinates[axis][i]);
            box.high[axis] = std::max(box.high[axis], coordinates[axis][i]);
        }
    return box;
}

/// Values at points of a list, two registers of lanes at a time while there are as many.
template <class Scratch>
void sum_points(const Scratch& scratch, const PointList& points, float* out) {
    std::size_t i = 0;
    const auto sum_group = [&]<int G>() {
        Lanes x[G], y[G], z[G], sum[G];
        for (int g = 0; g < G; ++g) {
            const std::size_t at = i + static_cast<std::size_t>(g) * Lanes::count;
            x[g] = Lanes::load(points.x + at);
            y[g] = Lanes::load(points.y + at);
            z[g] = Lanes::load(points.z + at);
            sum[g] = Lanes(0.0F);
        }
        for (const Candidates& c : scratch) sum_values<G>(view(c), x, y, z, sum);
        for (int g = 0; g < G; ++g) sum[g].store(out + i + static_cast<std::size_t>(g) * Lanes::count);
        i += G * Lanes::count;
    };
    while (points.count > i + Lanes::count) sum_group.template operator()<2>();
    if (points.count > i) sum_group.template operator()<1>();
}

/// Lanes beyond the last point repeat it.
void pad(PointList& points) {
    for (std::size_t i = points.count; i % (2 * Lanes::count) != 0; ++i) {
        points.x[i] = points.x[points.count - 1];
        points.y[i] = points.y[points.count - 1];
        points.z[i] = points.z[points.count - 1];
    }
}

}  // namespace

Candidates::Candidates(const std::shared_ptr<MemoryAccount>& account)
    : x(make_array<float>(account)), y(make_array<float>(account)), z(make_array<float>(account)), weight(make_array<float>(account)) {}

void Candidates::reserve(std::size_t n) {
    if (n <= x.size()) return;
    for (Array<float>* a : {&x, &y, &z, &weight}) a->resize(n);
}

void Candidates::gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box) {
    count = 0;
    inverse_support = 1.0F / set.support;
    if (set.cells.brick_count == 0) return;
    set.for_each_near(origin, box, [this](float px, float py, float pz, float w) {
        if (count == x.size()) reserve(std::max<std::size_t>(256, 2 * count));
        x[count] = px;
        y[count] = py;
        z[count] = pz;
        weight[count] = w;
        ++count;
    });
}

ParticleField::ParticleField(const std::shared_ptr<MemoryAccount>& account, Workers& workers, ParticleSets& sets)
    : workers_(workers), sets_(sets) {
    for (unsigned i = 0; i < workers.count(); ++i)
        scratch_.push_back({Candidates(account), Candidates(account), Candidates(account), Candidates(account)});
}

void ParticleField::gather(const Units3& origin, const UnitBox& box, Scratch& scratch) const {
    for (unsigned k = 0; k < particle_level_count; ++k) scratch[k].gather(sets_[k].view(), origin, box);
}

void ParticleField::gather(const Int3& base_cell, const PointList& points, Scratch& scratch) const {
    gather(base_cell_origin(base_cell), box_of(points), scratch);
}

void ParticleField::even_out_scratch() {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        std::size_t most = 0;
        for (const Scratch& s : scratch_) most = std::max(most, s[k].x.size());
        for (Scratch& s : scratch_) s[k].reserve(most);
    }
}

void ParticleField::divide_weights_by_density() {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets_[k];
        // A density is read from the weights that it will change: all are computed before any is divided.
        resize_for_overwrite(set.densities, set.particles.size());
        const BrickGridView grid = set.cells.view();
        workers_.for_ranges(grid.brick_count, 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
            Scratch& scratch = scratch_[worker];
            PointList points;
            alignas(32) float out[max_points];
            for (std::size_t b = begin; b < end; ++b) {
                const Brick& brick = grid.bricks[b];
                std::uint32_t cell = brick.first;
                for (int w = 0; w < Brick::words; ++w)
                    for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++cell) {
                        const int p = 64 * w + lowest_bit(left);
                        const std::int64_t in_brick[3] = {(p & 15) * set.cell_units, (p >> 4 & 15) * set.cell_units, (p >> 8) * set.cell_units};
                        const std::int64_t edge = set.cell_units * brick_size;
                        const Units3 origin{brick.coordinate.x * edge + in_brick[0], brick.coordinate.y * edge + in_brick[1],
                                            brick.coordinate.z * edge + in_brick[2]};
                        for (std::uint32_t i = set.first[cell]; i < set.first[cell + 1];) {
                            const std::uint32_t first = i;
                            points.count = 0;
                            for (; i < set.first[cell + 1] && points.count < max_points; ++i)
                                points.add(set.particles[i].x - static_cast<float>(in_brick[0]), set.particles[i].y - static_cast<float>(in_brick[1]),
                                           set.particles[i].z - static_cast<float>(in_brick[2]));
                            pad(points);
                            gather(origin, box_of(points), scratch);
                            sum_points(scratch, points, out);
                            std::copy(out, out + points.count, set.densities.begin() + first);
                        }
                    }
            }
        });
    }
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets_[k];
        workers_.for_ranges(set.particles.size(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) set.particles[i].weight /= set.densities[i];
        });
    }
    even_out_scratch();
}

void ParticleField::sample_base_vertices(Surface& s, Array<float>& bounds) {
    resize_for_overwrite(bounds, s.block_count());
    s.samples.reserve(s.block_count());
    s.samples.resize(s.block_count());
    // Base vertices of 2 x 2 x 2 cells fill the lanes; their cells' bounds need the same particles.
    constexpr int clusters = brick_size / 2;
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        Scratch& scratch = scratch_[worker];
        constexpr float edge = units_per_base_cell;
        alignas(32) float lane_x[8], lane_y[8], lane_z[8], value[8], bound[8];
        for (int i = 0; i < 8; ++i) {
            lane_x[i] = static_cast<float>(i & 1) * edge;
            lane_y[i] = static_cast<float>(i >> 1 & 1) * edge;
            lane_z[i] = static_cast<float>(i >> 2) * edge;
        }
        const Lanes x = Lanes::load(lane_x), y = Lanes::load(lane_y), z = Lanes::load(lane_z);
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            for (int cluster = 0; cluster < clusters * clusters * clusters; ++cluster) {
                const Int3 corner{cluster % clusters * 2, cluster / clusters % clusters * 2, cluster / (clusters * clusters) * 2};
                const auto place = [&](int i) { return index_in_brick(corner + Int3{i & 1, i >> 1 & 1, i >> 2}); };
                bool any = false;
                for (int i = 0; i < 8; ++i) any |= brick.holds(place(i));
                if (!any) continue;
                const Int3 base{brick.coordinate.x * brick_size + corner.x, brick.coordinate.y * brick_size + corner.y,
                                brick.coordinate.z * brick_size + corner.z};
                gather(base_cell_origin(base), {{0.0F, 0.0F, 0.0F}, {2 * edge, 2 * edge, 2 * edge}}, scratch);
                const Lanes px[1] = {x}, py[1] = {y}, pz[1] = {z};
                Lanes sum[1] = {Lanes(0.0F)};
                Lanes most(0.0F);
                for (const Candidates& c : scratch) {
                    sum_values<1>(view(c), px, py, pz, sum);
                    sum_bounds(view(c), x + Lanes(edge / 2), y + Lanes(edge / 2), z + Lanes(edge / 2), edge / 2, most);
                }
                sum[0].store(value);
                most.store(bound);
                for (int i = 0; i < 8; ++i) {
                    if (!brick.holds(place(i))) continue;
                    const std::uint32_t block = brick.number(place(i));
                    s.samples[block] = value[i];
                    bounds[block] = bound[i];
                    s.first_sample[block] = block;
                    s.sampled[block] = 1;
                    const Int3 at = base + Int3{i & 1, i >> 1 & 1, i >> 2};
                    const bool allowed = !s.settings.has_domain ||
                                         (domain_points(at, s.settings.domain_low, s.settings.domain_high) & 1) != 0;
                    s.inside[block] = allowed && value[i] > s.settings.iso ? 1 : 0;
                }
            }
        }
    });
    s.field_evaluations += s.block_count();
    even_out_scratch();
}

void ParticleField::values(const Int3& base_cell, PointList& points, float* values, unsigned worker) {
    pad(points);
    gather(base_cell, points, scratch_[worker]);
    sum_points(scratch_[worker], points, values);
}

void ParticleField::gradients(const Int3& base_cell, PointList& points, float* x, float* y, float* z, unsigned worker) {
    pad(points);
    gather(base_cell, points, scratch_[worker]);
    for (std::size_t i = 0; i < points.count; i += Lanes::count) {
        const Lanes px = Lanes::load(points.x + i), py = Lanes::load(points.y + i), pz = Lanes::load(points.z + i);
        Lanes gx(0.0F), gy(0.0F), gz(0.0F);
        for (const Candidates& c : scratch_[worker]) sum_gradients(view(c), px, py, pz, gx, gy, gz);
        gx.store(x + i);
        gy.store(y + i);
        gz.store(z + i);
    }
}

}  // namespace meniscus::cpu
