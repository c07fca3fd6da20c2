#include "steps/split_cells/split_cells.hpp"

#include "engine/cuda/candidates.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// Calls visit(word's number, its members, bit, block) for the words of bricks with members, each by all lanes of a
/// warp: half a word at a time, a lane for every bit. `block` is meaningful where the bit is a member.
template <class Visit>
__device__ void each_word_by_warp(const Frame& f, const Visit& visit) {
    each_by_warp(Brick::words * f.count(Resource::bricks), [&](std::uint32_t i) {
        const Brick& brick = f.bricks[i / Brick::words];
        const int w = static_cast<int>(i % Brick::words);
        const std::uint64_t members = brick.occupied[w];
        for (int half = 0; half < 2; ++half) {
            const int bit = static_cast<int>(lane_index()) + 32 * half;
            const auto before = static_cast<std::uint32_t>(popcount(members & ((std::uint64_t{1} << bit) - 1)));
            visit(i, members, bit, brick.first + brick.rank[w] + before);
        }
    });
}

/// All words: those without a member are neighbors of others.
__global__ void __launch_bounds__(block_threads) collect_base_vertices(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    const BandTest test{f.settings.iso, f.settings.deep_inside};
    each_word_by_warp(f, [&](std::uint32_t word, std::uint64_t members, int bit, std::uint32_t block) {
        const bool exists = (members >> bit & 1) != 0;
        const bool inside = exists && (blocks.inside[block] & 1) != 0;
        const bool deep = inside && test.is_deep(blocks.value(block, 0));
        const std::uint32_t all_inside = __ballot_sync(all_lanes, inside ? 1 : 0);
        const std::uint32_t all_deep = __ballot_sync(all_lanes, deep ? 1 : 0);
        if (lane_index() != 0) return;
        // The lower half of a word comes first in memory.
        const std::uint64_t half = 2 * std::uint64_t{word} + (bit != 0 ? 1 : 0);
        reinterpret_cast<std::uint32_t*>(f.base_inside)[half] = all_inside;
        reinterpret_cast<std::uint32_t*>(f.base_deep)[half] = all_deep;
    });
}

/// Cells of the band get level 1.
__global__ void __launch_bounds__(block_threads, 4) find_band(const __grid_constant__ Frame f, bool bends) {
    const BaseVertexSets vertices = f.base_vertices();
    const BandTest test{f.settings.iso, f.settings.deep_inside};
    each_word_by_warp(f, [&](std::uint32_t word, std::uint64_t members, int bit, std::uint32_t block) {
        if (members == 0) return;
        const CornerSets corners(vertices, word / Brick::words, static_cast<int>(word % Brick::words));
        const bool exists = (members >> bit & 1) != 0;
        const bool in_band = exists && corners.may_hold_surface(bit, test, f.reaches[block].bound);
        if (exists) f.level[block] = in_band ? 1 : 0;
        if (!bends) return;
        if (exists) f.bends[block] = {0.0F, 1};
        const std::uint32_t at = take_places(&f.counts->listed[static_cast<int>(List::bends)], in_band ? 1 : 0);
        if (in_band) f.work[at] = block;
    });
}

__global__ void __launch_bounds__(block_threads, 2) measure_bends(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    const BlobRule blobs{f.settings.blob_closest, f.settings.blob_level};
    const float iso = f.settings.iso;
    const std::uint32_t cells = f.listed(List::bends);
    GridLoop{}.each(cells, [&](std::uint32_t i) {
        const std::uint32_t block = f.work[i];
        const ClosedCell cell(blocks, block);
        CellCorners<float> corners;
        int inside_corners = 0;
        for (int k = 0; k < 8; ++k) {
            corners.value[k] = (cell.block[k] == no_index ? 0.0F : blocks.value(cell.block[k], 0)) - iso;
            inside_corners += static_cast<int>(blocks.inside_or_none(cell.block[k]) & 1);
        }
        // Relative to the corner of the cell's cluster, as on the CPU: the search meets points that are no whole units.
        const Int3 at = blocks.coordinate(block);
        const Int3 cluster{at.x & ~1, at.y & ~1, at.z & ~1};
        constexpr float edge = units_per_base_cell;
        const Point3<float> corner{static_cast<float>(at.x - cluster.x) * edge,
                                   static_cast<float>(at.y - cluster.y) * edge,
                                   static_cast<float>(at.z - cluster.z) * edge};
        const auto jet_at = [&](const Point3<float>& p) {
            FieldJet<float> jet;
            // Wider by a unit, since the sides of the box are rounded.
            const UnitBox box{{p.x - 1.0F, p.y - 1.0F, p.z - 1.0F}, {p.x + 1.0F, p.y + 1.0F, p.z + 1.0F}};
            for_each_candidate(f, base_cell_origin(cluster), box,
                               [&](const OneCandidate& c) { sum_jets(c.view(), p.x, p.y, p.z, jet); });
            return jet;
        };
        const SurfaceSearch<float> search =
            search_surface(corners, is_mixed(inside_corners) ? 1.0F : 0.0F, corner, iso, jet_at);
        f.bends[block] = cell_bend(search, inside_corners, blobs.least_level(inside_corners, f.reaches[block]));
    });
    if (blockIdx.x == 0 && threadIdx.x == 0) f.counts->field_evaluations += Counter{2} * cells;
}

template <class Rule>
__global__ void __launch_bounds__(block_threads) choose_levels(const __grid_constant__ Frame f, const Rule level_of) {
    const BlocksView blocks = f.blocks();
    GridLoop{}.each(blocks.count, [&](std::uint32_t b) {
        f.wanted_level[b] = static_cast<std::uint8_t>(level_of(blocks, b));
        if (f.level[b] != 0) f.level[b] = f.wanted_level[b];
    });
}

/// One thread for every word of a brick.
__global__ void __launch_bounds__(block_threads) list_level_sets(const __grid_constant__ Frame f) {
    const LevelSets levels = f.level_sets();
    GridLoop{}.each(std::uint64_t{Brick::words} * f.count(Resource::bricks), [&](std::uint32_t i) {
        const Brick& brick = f.bricks[i / Brick::words];
        const int w = static_cast<int>(i % Brick::words);
        std::uint64_t level1 = 0, level2 = 0, level3 = 0;
        std::uint32_t block = brick.first + brick.rank[w];
        for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++block) {
            const std::uint64_t cell = left & (~left + 1);
            const int level = f.level[block];
            if (level >= 1) level1 |= cell;
            if (level >= 2) level2 |= cell;
            if (level >= 3) level3 |= cell;
        }
        f.at_least[1][i] = level1;
        f.at_least[2][i] = level2;
        f.at_least[3][i] = level3;
        f.raised[i] = 0;
    });
}

void choose_by(const CurvatureCriterion& chosen, const Frame& frame, bool, const Launcher& launch) {
    const std::uint64_t blocks = frame.capacity[Resource::blocks];
    launch(blocks, block_threads, measure_bends, frame);
    launch(blocks, block_threads, choose_levels<CurvatureRule>, frame,
           CurvatureRule{frame.bends, static_cast<float>(chosen.tolerance)});
}

void choose_by(const CountCriterion& chosen, const Frame& frame, bool has_particle_levels, const Launcher& launch) {
    launch(frame.capacity[Resource::blocks], block_threads, choose_levels<CountRule>, frame,
           CountRule{frame.particle_counts, chosen.threshold, has_particle_levels});
}

}  // namespace

void split_cells(const Frame& frame, const Settings& user, bool has_particle_levels, const Launcher& launch) {
    const bool adaptive = user.mode == Mode::adaptive;
    const bool bends = adaptive && std::holds_alternative<CurvatureCriterion>(user.criterion);
    const std::uint64_t words = Brick::words * frame.capacity[Resource::bricks];
    launch(words, block_warps, collect_base_vertices, frame);
    launch(words, block_warps, find_band, frame, bends);
    if (adaptive)
        std::visit([&](const auto& chosen) { choose_by(chosen, frame, has_particle_levels, launch); }, user.criterion);
    else
        launch(frame.capacity[Resource::blocks], block_threads, choose_levels<UniformRule>, frame, UniformRule{});
    collect_level_sets(frame, launch);
}

void collect_level_sets(const Frame& frame, const Launcher& launch) {
    launch(Brick::words * frame.capacity[Resource::bricks], block_threads, list_level_sets, frame);
}

}  // namespace meniscus::cuda
