// The base cells that the particles reach, on the CPU: brick by brick, a slice at a time.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include "steps/cpu_steps.hpp"
#include "steps/register_particles/register_particles.hpp"

namespace meniscus::cpu {
namespace {

/// A slice of a brick at one z: its rows one after the other, four in a word.
constexpr int words_of_slice = Brick::words / brick_size;
static_assert(std::endian::native == std::endian::little);

/// Marks the base cells of a brick that a particle reaches, a slice at a time; returns ReachedBox::count().
std::uint32_t mark_reached(Brick& brick, float x, float y, float z, float support) {
    const float reach = support + 16.0F;
    const ReachedBox box({x, y, z}, reach);
    if (box.empty()) return 0;
    const std::uint64_t rows = row_bits(box.low[1], box.high[1]);
    std::uint64_t widest[words_of_slice];
    for (int w = 0; w < words_of_slice; ++w) {
        // Four bits, each moved to the begin of its row.
        const std::uint64_t four = rows >> (4 * w);
        const std::uint64_t starts = (four & 1) | (four & 2) << 15 | (four & 4) << 30 | (four & 8) << 45;
        widest[w] = starts * row_bits(box.low[0], box.high[0]);
    }
    WideLanes gap_y[brick_size / WideLanes::count];
    alignas(64) float row_numbers[brick_size];
    for (int i = 0; i < brick_size; ++i) row_numbers[i] = static_cast<float>(i);
    for (int r = 0; r < brick_size / WideLanes::count; ++r)
        gap_y[r] = gap_to_cells(y, WideLanes::load(row_numbers + r * WideLanes::count));
    for (int cz = box.low[2]; cz <= box.high[2]; ++cz) {
        std::uint64_t* const slice = brick.occupied + cz * words_of_slice;
        // Most particles lie among others, which have marked all this.
        std::uint64_t unmarked = 0;
        for (int w = 0; w < words_of_slice; ++w) unmarked |= widest[w] & ~slice[w];
        if (unmarked == 0) continue;
        const float gap_z = gap_to_cells(z, static_cast<float>(cz));
        std::uint16_t reached[brick_size] = {};
        for (int r = 0; r < brick_size / WideLanes::count; ++r) {
            const int first = r * WideLanes::count;
            const ReachedRows<WideLanes> cells(x, gap_y[r], gap_z, reach);
            add_spans(reached + first, cells.first, cells.last,
                      cells.set & static_cast<unsigned>(rows >> first) & ((1U << WideLanes::count) - 1));
        }
        std::uint64_t of_words[words_of_slice];
        std::memcpy(of_words, reached, sizeof of_words);
        for (int w = 0; w < words_of_slice; ++w) slice[w] |= of_words[w];
    }
    return box.count();
}

/// Each brick is touched, so that the system gives its pages: lone particles by the million have gigabytes of them.
void resize_in_parts(Array<Brick>& bricks, std::size_t n, const Workers& workers) {
    constexpr std::size_t at_once = 4096;
    if (bricks.capacity() < n) {
        release(bricks);
        bricks.reserve(with_room_to_grow(n));
    }
    do {
        workers.go_on();
        bricks.resize(std::min(bricks.size() + at_once, n));
    } while (bricks.size() < n);
}

}  // namespace

std::uint64_t mark_reached_cells(ParticleSets& sets, BrickGrid& grid) {
    // Every brick that a support cell's particles may reach, each once.
    constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
    sets.reached_bricks.clear();
    for (const ParticleSet& set : sets.of_level) {
        ReachedBricks last;
        for (std::size_t i = 0; i < set.cell_keys.size(); ++i) {
            if (i % 1024 == 0) sets.workers.go_on();
            const ReachedBricks reached = reached_bricks(set.cell_keys[i], set.cell_units, set.support);
            if (i > 0 && reached == last) continue;
            last = reached;
            const auto& [low, high] = reached;
            Int3 c;
            for (c.z = low.z; c.z <= high.z; ++c.z)
                for (c.y = low.y; c.y <= high.y; ++c.y)
                    for (c.x = low.x; c.x <= high.x; ++c.x) sets.reached_bricks.push_back(brick_key(c));
        }
    }
    sets.workers.sort(sets.reached_bricks.data(), sets.reached_bricks.data() + sets.reached_bricks.size(),
                      std::less<>());
    sets.reached_bricks.erase(std::unique(sets.reached_bricks.begin(), sets.reached_bricks.end()),
                              sets.reached_bricks.end());

    resize_in_parts(grid.bricks, sets.reached_bricks.size(), sets.workers);
    resize_for_overwrite(grid.keys, sets.reached_bricks.size());
    std::atomic<std::uint64_t> pairs{0};
    sets.workers.for_ranges(sets.reached_bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            Brick& brick = grid.bricks[i];
            grid.keys[i] = sets.reached_bricks[i];
            brick.coordinate = brick_coordinate(sets.reached_bricks[i]);
            brick.clear();
            const Units3 origin{brick.coordinate.x * edge, brick.coordinate.y * edge, brick.coordinate.z * edge};
            const auto size = static_cast<float>(edge);
            std::uint64_t marked = 0;
            for (const ParticleSet& set : sets.of_level) {
                // Coincident particles follow one another, and mark the same.
                float last[4] = {NAN, NAN, NAN, NAN};
                std::uint32_t by_last = 0;
                set.view().for_each_near(origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}},
                                         [&, view = set.view()](float x, float y, float z, std::uint32_t particle) {
                                             if (particle % 16384 == 0) sets.workers.go_on();
                                             const float support = view.support_of(particle);
                                             if (x != last[0] || y != last[1] || z != last[2] || support != last[3])
                                                 by_last = mark_reached(brick, x, y, z, support);
                                             marked += by_last;
                                             last[0] = x;
                                             last[1] = y;
                                             last[2] = z;
                                             last[3] = support;
                                         });
            }
            const bool are_few = sets.settings.leaves_cells_out();
            for (int w = 0; w < Brick::words && are_few; ++w)
                brick.occupied[w] &= storable_word(sets.settings, brick.coordinate, w);
            pairs.fetch_add(pairs_in_brick(marked, are_few ? brick.count() : 0, are_few), std::memory_order_relaxed);
        }
    });
    return pairs.load(std::memory_order_relaxed);
}

}  // namespace meniscus::cpu
