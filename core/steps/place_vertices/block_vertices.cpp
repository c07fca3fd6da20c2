// A block's vertices, found bit by bit in the words of its crossed edges.
#include "steps/place_vertices/block_vertices.hpp"

#include <algorithm>
#include <iterator>

#include "field/lanes.hpp"

namespace meniscus::cpu {
namespace {

/// The values of a block's sampled points by point, unpacked where not all points are sampled.
class UnpackedValues {
public:
    void read(const BlocksView& blocks, std::uint32_t block) {
        of_ = room_;
        if (block == no_index) {
            std::fill(std::begin(room_), std::end(room_), 0.0F);
        } else if (blocks.sampled[block] == ~BlockMask{0}) {
            of_ = blocks.samples + blocks.first_sample[block];
            // Clusters walk along four rows of blocks: the next one reads the block after the next of this row.
            for (int line = 0; line < 64; line += 16) __builtin_prefetch(of_ + 128 + line);
        } else {
            const float* next = blocks.samples + blocks.first_sample[block];
            for (BlockMask left = blocks.sampled[block]; left != 0; left &= left - 1) room_[lowest_bit(left)] = *next++;
        }
    }
    float operator()(int bit) const { return of_[bit]; }

private:
    const float* of_ = nullptr;
    float room_[64];
};

}  // namespace

void find_vertices(const BlocksView& blocks, std::uint32_t block, BlockVertices& vertices) {
    UnpackedValues own, next;
    own.read(blocks, block);
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        vertices.first[axis] = count;
        const BlockMask edges = blocks.edges[block].axis[axis];
        const BlockMask high_face = low_face(axis) << (3 * bit_step(axis));
        if ((edges & high_face) != 0) next.read(blocks, blocks.neighbor(block, axis_offset(axis)));
        // Which of the two blocks holds an edge's upper end is as good as random: chosen without a branch.
        const UnpackedValues* const above[2] = {&own, &next};
        const int step[2] = {bit_step(axis), -3 * bit_step(axis)};
        for (BlockMask left = edges; left != 0; left &= left - 1, ++count) {
            const int bit = lowest_bit(left);
            const auto beyond = static_cast<std::size_t>(high_face >> bit & 1);
            vertices.bit[count] = static_cast<std::uint8_t>(bit);
            vertices.low[count] = own(bit);
            vertices.high[count] = (*above[beyond])(bit + step[beyond]);
        }
    }
    vertices.first[3] = vertices.count = count;
    for (std::size_t i = count; i % WideLanes::count != 0; ++i) {
        vertices.low[i] = 0.0F;
        vertices.high[i] = 1.0F;
    }
}

}  // namespace meniscus::cpu
