// The lattice behind the mesh, kept on the CPU.
#include "steps/keep_lattice/keep_lattice.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "engine/arrays.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// Finds the blocks of one brick after the other.
class BrickBlocks {
public:
    explicit BrickBlocks(const BlocksView& blocks) : blocks_(blocks) {}

    /// cells: those of the brick that see both signs. Writes from `out` on, and returns the number of blocks.
    std::uint32_t find(std::span<const std::uint32_t> cells, LatticeBlock* out) {
        ClosedPlaces places;
        for (const std::uint32_t cell : cells) {
            const ClosedCell closed(blocks_, cell);
            const int level = blocks_.level[cell];
            if (!draws(blocks_, closed, level)) continue;
            const int place = closed_place_of(blocks_.place[cell]);
            places.add_cell(place);
            for (int i = 0; i < 8; ++i) block_at_[at(place + closed_steps(i))] = closed.block[i];
            level_at_[at(place)] = static_cast<std::uint8_t>(level);
        }
        std::uint32_t count = 0;
        places.for_each([&](int place) {
            LatticeBlock& block = out[count++] = {};
            block.place = static_cast<std::uint16_t>(place);
            block.level = std::exchange(level_at_[at(place)], std::uint8_t{0});
            const std::uint32_t number = block_at_[at(place)];
            if (number == no_index) return;
            block.inside = blocks_.inside[number];
            for (std::size_t axis = 0; axis < 3; ++axis) block.edges[axis] = blocks_.edges[number].axis[axis];
            block.first_vertex = blocks_.first_vertex[number];
            if (block.level != 0)
                block.coarser = static_cast<std::uint8_t>(coarser_beyond_brick(blocks_, number, block.level));
        });
        return count;
    }

private:
    static std::size_t at(int place) { return static_cast<std::size_t>(place); }

    const BlocksView& blocks_;
    std::array<std::uint32_t, closed_places> block_at_;  ///< of the places that a brick has used
    std::array<std::uint8_t, closed_places> level_at_{};
};

}  // namespace

void keep_lattice(State& state, Mesh& mesh) {
    const BlocksView blocks = state.blocks();
    SurfaceLattice& lattice = mesh.lattice;
    resize_for_overwrite(lattice.bricks, mesh.bricks.size());
    const auto mixed_cells_of = [&](std::size_t b) {
        const auto& at = mesh.bricks[b].coordinate;
        const std::uint32_t brick = blocks.grid.find({at[0], at[1], at[2]});
        const std::uint32_t end =
            brick + 1 < state.grid.bricks.size() ? state.grid.bricks[brick + 1].first : state.block_count();
        const auto first = std::ranges::lower_bound(state.mixed_cells, state.grid.bricks[brick].first);
        return std::span<const std::uint32_t>(first, std::lower_bound(first, state.mixed_cells.end(), end));
    };
    // Room for the blocks of all cells that see both signs: a few of them draw nothing at their own level.
    state.workers.for_ranges(mesh.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            ClosedPlaces places;
            for (const std::uint32_t cell : mixed_cells_of(b)) places.add_cell(closed_place_of(blocks.place[cell]));
            lattice.bricks[b].count = places.count();
        }
    });
    std::uint32_t room = 0;
    for (LatticeRange& range : lattice.bricks) {
        range.first = room;
        room += range.count;
    }
    resize_for_overwrite(lattice.blocks, room);
    state.workers.for_ranges(mesh.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        BrickBlocks found(blocks);
        for (std::size_t b = begin; b < end; ++b)
            lattice.bricks[b].count = found.find(mixed_cells_of(b), lattice.blocks.data() + lattice.bricks[b].first);
    });
}

}  // namespace meniscus::cpu
