#include "engine/cpu/surface.hpp"
#include "engine/numbering.hpp"

namespace meniscus::cpu {

Surface::Surface(const std::shared_ptr<MemoryAccount>& account, Workers& own_workers,
                 const LatticeSettings& own_settings)
    : workers(own_workers),
      settings(own_settings),
      grid(account),
      brick(make_array<std::uint32_t>(account)),
      place(make_array<std::uint16_t>(account)),
      level(make_array<std::uint8_t>(account)),
      sampled(make_array<BlockMask>(account)),
      inside(make_array<BlockMask>(account)),
      wanted_points(make_array<BlockMask>(account)),
      first_sample(make_array<std::uint32_t>(account)),
      edges(make_array<EdgeMasks>(account)),
      first_vertex(make_array<std::uint32_t>(account)),
      slots(make_array<TriangleSlots>(account)),
      samples(make_array<float>(account)),
      mixed_cells(make_array<std::uint32_t>(account)),
      has_cracks(make_array<std::uint8_t>(account)),
      brick_triangles(make_array<std::array<std::uint32_t, triangle_level_count>>(account)),
      brick_counts(make_array<std::uint64_t>(account)),
      any_inside(make_array<std::uint64_t>(account)),
      all_inside(make_array<std::uint64_t>(account)),
      base_deep(make_array<std::uint64_t>(account)),
      at_least{make_array<std::uint64_t>(account), make_array<std::uint64_t>(account),
               make_array<std::uint64_t>(account)},
      chosen(make_array<std::uint64_t>(account)),
      stale{make_array<std::uint64_t>(account), make_array<std::uint64_t>(account), make_array<std::uint64_t>(account),
            make_array<std::uint64_t>(account), make_array<std::uint64_t>(account)} {}

BlocksView Surface::view() {
    return {grid.view(),   grid.members,        brick.data(),   place.data(), level.data(),        sampled.data(),
            inside.data(), first_sample.data(), samples.data(), edges.data(), first_vertex.data(), slots.data()};
}

LevelSets Surface::level_sets() {
    const BrickGridView cells = grid.view();
    return {{{}, {cells, at_least[0].data()}, {cells, at_least[1].data()}, {cells, at_least[2].data()}}};
}

void number_members(BrickGrid& grid, Workers& workers) {
    std::uint64_t total = 0;
    for (Brick& b : grid.bricks) {
        b.first = static_cast<std::uint32_t>(total);
        total += b.count();
        require_numbers(total, "the frame reaches", "base cells");
    }
    grid.members = static_cast<std::uint32_t>(total);
    resize_for_overwrite(grid.neighbors, grid.bricks.size());
    const BrickGridView view = grid.view();
    workers.for_ranges(grid.bricks.size(), 64, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            const Int3 at = grid.bricks[b].coordinate;
            for (int i = 0; i < neighbor_slots; ++i) grid.neighbors[b].brick[i] = view.find(at + neighbor_offset(i));
        }
    });
}

void store_blocks(Surface& s) {
    const std::size_t n = s.block_count();
    resize_for_overwrite(s.brick, n);
    resize_for_overwrite(s.place, n);
    resize_for_overwrite(s.level, n);
    resize_for_overwrite(s.sampled, n);
    resize_for_overwrite(s.inside, n);
    resize_for_overwrite(s.wanted_points, n);
    resize_for_overwrite(s.first_sample, n);
    resize_for_overwrite(s.edges, n);
    resize_for_overwrite(s.first_vertex, n);
    resize_for_overwrite(s.slots, n);
    // Passes do not write the words without a member.
    for (auto* set : {&s.any_inside, &s.all_inside, &s.chosen}) set->assign(s.grid.bricks.size() * Brick::words, 0);
    s.samples.clear();
    s.field_evaluations = 0;
    s.workers.for_ranges(s.grid.bricks.size(), 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            std::uint32_t block = brick.first;
            for (int w = 0; w < Brick::words; ++w)
                for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++block) {
                    s.brick[block] = static_cast<std::uint32_t>(b);
                    s.place[block] = static_cast<std::uint16_t>(64 * w + lowest_bit(left));
                    s.level[block] = 0;
                    s.sampled[block] = 0;
                    s.inside[block] = 0;
                    s.first_sample[block] = 0;
                }
        }
    });
}

}  // namespace meniscus::cpu
