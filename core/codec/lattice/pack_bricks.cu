// A thread block writes a part of a brick, a thread its blocks: where their bits go is known beforehand.
#include "codec/lattice/pack_bricks.hpp"

#include "codec/lattice/bit_stream.hpp"
#include "codec/lattice/octahedron.hpp"
#include "codec/round_position.hpp"
#include "engine/cuda/block_sums.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/keep_lattice/keep_lattice.hpp"

namespace meniscus::cuda {
namespace {

using Word = unsigned long long;  // what atomicOr takes

/// Writes successive bits among those of other threads, which are zero before.
class BitsAmongOthers {
public:
    /// bit: counted from the brick's first byte.
    __device__ BitsAmongOthers(std::byte* brick, std::uint64_t bit) : next_(reinterpret_cast<Word*>(brick) + bit / 64) {
        word_.filled = static_cast<int>(bit % 64);
    }
    __device__ ~BitsAmongOthers() {
        if (word_.bits != 0) atomicOr(next_, Word{word_.bits});
    }
    BitsAmongOthers(const BitsAmongOthers&) = delete;
    BitsAmongOthers& operator=(const BitsAmongOthers&) = delete;

    __device__ void put(std::uint64_t value, int bits) {
        word_.put(value, bits, [this](std::uint64_t word) { atomicOr(next_++, Word{word}); });
    }

private:
    Word* next_;
    BitWord word_;
};

/// The cells of a brick that draw, row by row: in shared memory.
struct CellRows {
    std::uint32_t row[brick_size * brick_size];  ///< row y + 16 z: a bit for each x
    BlockSums<1> sums;

    static_assert(sizeof(row) / sizeof(*row) == block_threads);

    __device__ void write(std::byte* brick, std::uint64_t first_bit) {
        const std::uint32_t own = row[threadIdx.x];
        std::uint32_t before[1] = {own != 0 ? 1U : 0U};
        std::uint32_t all[1];
        sums.sum_below(before, all);
        const unsigned y = threadIdx.x % brick_size;
        const unsigned z = threadIdx.x / brick_size;
        // Each slice has a word that says which of its rows follow.
        const std::uint64_t at = first_bit + brick_size * (std::uint64_t{z} + before[0]);
        if (y == 0) {
            std::uint32_t slice = 0;
            for (unsigned i = 0; i < brick_size; ++i) slice |= (row[threadIdx.x + i] != 0 ? 1U : 0U) << i;
            BitsAmongOthers(brick, at).put(slice, brick_size);
        }
        if (own != 0) BitsAmongOthers(brick, at + brick_size).put(own, brick_size);
    }
};

/// Parts of a brick. One thread block for a whole brick would keep the device waiting for the fullest one.
constexpr std::uint32_t parts_of_brick = 8;

/// The blocks of a part of a brick that a warp's lanes have, neighboring ones.
class WarpBlocks {
public:
    /// first: of the warp, counted from the brick's.
    __device__ WarpBlocks(const LatticeOnDevice& mesh, const KeptBrick& brick, std::uint32_t first)
        : mesh_(mesh), first_(brick.first + first), exists_(first + lane_index() < brick.blocks) {}

    __device__ bool exists() const { return exists_; }
    __device__ const LatticeBlock& block() const { return mesh_.blocks[first_ + lane_index()]; }
    __device__ const KeptBlock& kept() const { return mesh_.kept[first_ + lane_index()]; }

    /// Calls visit(exists, kept block, n, vertex) for the vertices that the brick's cells have in these blocks: the
    /// n-th of a block, a lane for each, in their order. All lanes call it together, some for none.
    template <class Visit>
    __device__ void each_vertex(const Visit& visit) const {
        std::uint32_t total = 0;
        const std::uint32_t below =
            sum_of_lanes_below(exists_ ? static_cast<std::uint32_t>(kept().edges.count()) : 0, total);
        for (std::uint32_t begin = 0; begin < total; begin += warp_threads) {
            const std::uint32_t i = begin + lane_index();
            const bool exists = i < total;
            const unsigned lane = lane_with(exists ? i : total - 1, below);
            const std::uint32_t n = i - __shfl_sync(all_lanes, below, static_cast<int>(lane));
            const LatticeBlock& block = mesh_.blocks[first_ + lane];
            const KeptBlock& kept = mesh_.kept[first_ + lane];
            BrickVertex vertex{};
            if (exists) vertex = nth_brick_vertex(block.edges, block.first_vertex, kept.edges, n);
            visit(exists, kept, n, vertex);
        }
    }

private:
    const LatticeOnDevice& mesh_;
    std::uint32_t first_;
    bool exists_;
};

/// The lanes of a warp write values of up to 32 bits among bits that are zero before. The places ascend from lane to
/// lane; the first lane of a word writes for all. exists: whether the lane has a value.
__device__ void write_together(std::byte* brick, bool exists, std::uint64_t bit, std::uint64_t value, int bits) {
    const std::uint32_t word = exists ? static_cast<std::uint32_t>(bit / 64) : ~0U;
    const auto filled = static_cast<int>(bit % 64);
    const std::uint64_t beyond = exists && filled + bits > 64 ? value >> (64 - filled) : 0;
    std::uint64_t here = exists ? value << filled : 0;
    for (unsigned distance = 1; distance < warp_threads; distance *= 2) {
        const unsigned from = lane_index() + distance;
        const std::uint64_t other = __shfl_sync(all_lanes, here, static_cast<int>(from % warp_threads));
        const std::uint32_t its_word = __shfl_sync(all_lanes, word, static_cast<int>(from % warp_threads));
        if (from < warp_threads && its_word == word) here |= other;
    }
    const std::uint32_t before = __shfl_up_sync(all_lanes, word, 1);
    auto* const words = reinterpret_cast<Word*>(brick);
    if (here != 0 && (lane_index() == 0 || before != word)) atomicOr(words + word, Word{here});
    if (beyond != 0) atomicOr(words + word + 1, Word{beyond});
}

/// Calls visit(WarpBlocks) for the blocks of a part of a brick, by all threads of one thread block.
template <class Visit>
__device__ void each_warps_blocks(const LatticeOnDevice& mesh, const KeptBrick& brick, std::uint32_t part,
                                  const Visit& visit) {
    const std::uint32_t own = warp_threads * same_in_all_lanes(warp_in_block());
    for (std::uint32_t first = part * block_threads + own; first < brick.blocks;
         first += parts_of_brick * block_threads)
        visit(WarpBlocks(mesh, brick, first));
}

/// All of a block but the offsets and normals of its vertices.
__device__ void write_block(const PackedForm& form, const PackedCounts& counts, const PackedPlaces& fields,
                            const LatticeBlock& block, const KeptBlock& kept, std::byte* out) {
    if (block.level != 0 && !counts.has_one_level)
        BitsAmongOthers(out, fields.levels + level_bits * std::uint64_t{kept.before.cells})
            .put(block.level - 1U, level_bits);
    {
        BitsAmongOthers bits(out, fields.signs + kept.before.signs);
        put_signs(block.inside, kept.corners, bits);
    }
    if (kept.outer_faces != 0) {
        BitsAmongOthers bits(out, fields.faces + kept.before.faces);
        for (std::uint64_t left = kept.outer_faces; left != 0; left &= left - 1)
            bits.put(block.coarser >> lowest_bit(left) & 1, 1);
    }
    if ((kept.middles | kept.quarters) != 0) {
        BitsAmongOthers bits(out, fields.edges + kept.before.middles +
                                      static_cast<std::uint64_t>(form.offset_bits) * kept.before.vertices);
        put_signs(block.inside, kept.middles, bits);
        put_signs(block.inside, kept.quarters, bits);
    }
}

__device__ void write_vertices(const LatticeOnDevice& mesh, const PackedForm& form, const PackedPlaces& fields,
                               const WarpBlocks& blocks, std::byte* out) {
    blocks.each_vertex([&](bool exists, const KeptBlock& kept, std::uint32_t n, const BrickVertex& vertex) {
        const std::uint64_t number = std::uint64_t{kept.before.vertices} + n;
        const std::uint64_t middles =
            kept.before.middles + static_cast<std::uint64_t>(popcount(kept.middles) + popcount(kept.quarters));
        // Both loads come before what waits for the first.
        const std::int32_t coordinate =
            exists ? mesh.vertices[vertex.number][static_cast<std::size_t>(vertex.axis)] : 0;
        const Normal normal = exists && form.normal_bits != 0 ? mesh.normals[vertex.number] : Normal{};
        const std::uint64_t offset = edge_offset(coordinate, mesh.offset_bits, form.offset_bits);
        write_together(out, exists, fields.edges + middles + static_cast<std::uint64_t>(form.offset_bits) * number,
                       offset, form.offset_bits);
        if (form.normal_bits == 0) return;
        const Octahedron octahedron(form.normal_bits);
        const std::uint32_t code = octahedron.code(octahedron.point(normal));
        write_together(out, exists, fields.normals + static_cast<std::uint64_t>(2 * form.normal_bits) * number,
                       normal_field(code, form.normal_bits), 2 * form.normal_bits);
    });
}

/// Writes the fields that a brick has once: header, cells, its only level.
__device__ void write_begin(const LatticeOnDevice& mesh, const PackedForm& form, const KeptBrick& brick,
                            const PackedCounts& counts, const PackedPlaces& fields, CellRows& rows, std::byte* out) {
    rows.row[threadIdx.x] = 0;
    __syncthreads();
    for (std::uint32_t i = threadIdx.x; i < brick.blocks; i += block_threads) {
        const LatticeBlock& block = mesh.blocks[brick.first + i];
        if (block.level == 0) continue;
        const Int3 at = closed_coordinate(block.place);
        atomicOr(&rows.row[at.y + brick_size * at.z], 1U << at.x);
    }
    __syncthreads();
    rows.write(out, fields.cells);
    if (threadIdx.x == 0) {
        const BrickHeader header{
            .has_one_level = counts.has_one_level, .offset_bits = form.offset_bits, .normal_bits = form.normal_bits};
        BitsAmongOthers(out, 0).put(header.word(), 8 * static_cast<int>(BrickHeader::size));
        if (counts.has_one_level)
            BitsAmongOthers(out, fields.levels).put(static_cast<unsigned>(lowest_bit(brick.levels)) - 1, level_bits);
    }
    // The next brick's rows take the place of these.
    __syncthreads();
}

/// What each brick has once comes first, since a thread block looks at the whole brick for it. Without a wanted number
/// of blocks the compiler takes 48 registers and spills.
__global__ void __launch_bounds__(block_threads, 4)
    write_bricks(const LatticeOnDevice mesh, const PackedForm form, const PackedPlace* places, std::uint32_t count,
                 std::byte* all) {
    __shared__ CellRows rows;
    for (std::uint64_t i = blockIdx.x; i < (1 + std::uint64_t{parts_of_brick}) * count; i += gridDim.x) {
        const bool is_begin = i < count;
        const PackedPlace place = places[is_begin ? i : (i - count) / parts_of_brick];
        const KeptBrick brick = mesh.bricks[place.brick];
        const PackedCounts counts = packed_counts(brick);
        const PackedPlaces fields(counts, form.offset_bits, form.normal_bits);
        std::byte* const out = all + place.at;
        if (is_begin) {
            write_begin(mesh, form, brick, counts, fields, rows, out);
            continue;
        }
        each_warps_blocks(mesh, brick, static_cast<std::uint32_t>((i - count) % parts_of_brick),
                          [&](const WarpBlocks& blocks) {
                              if (blocks.exists())
                                  write_block(form, counts, fields, blocks.block(), blocks.kept(), out);
                              write_vertices(mesh, form, fields, blocks, out);
                          });
    }
}

__device__ void write_value(const AttributeOnDevice& attribute, std::uint32_t vertex, BitsAmongOthers& bits) {
    const std::byte* const value = attribute.values + std::size_t{vertex} * attribute.exact_bytes;
    if (attribute.bits == 0) {
        for (std::uint32_t i = 0; i < attribute.exact_bytes; ++i) bits.put(static_cast<std::uint8_t>(value[i]), 8);
        return;
    }
    const int width = attribute.bits <= 8 ? 8 : 16;
    for (std::uint32_t c = 0; c < attribute.components; ++c)
        bits.put(attribute.range[c].number(reinterpret_cast<const float*>(value)[c]), width);
}

/// Without a wanted number of blocks the compiler takes 32 registers and spills.
__global__ void __launch_bounds__(block_threads, 4)
    write_attribute(const LatticeOnDevice mesh, const PackedForm form,
                    const __grid_constant__ AttributeOnDevice attribute, std::uint32_t bytes_before,
                    const PackedPlace* places, std::uint32_t count, std::byte* all) {
    for (std::uint64_t i = blockIdx.x; i < std::uint64_t{parts_of_brick} * count; i += gridDim.x) {
        const PackedPlace place = places[i / parts_of_brick];
        const KeptBrick brick = mesh.bricks[place.brick];
        const PackedPlaces fields(packed_counts(brick), form.offset_bits, form.normal_bits);
        const std::uint64_t first =
            fields.attributes + 8 * std::uint64_t{bytes_before} * std::uint64_t{brick.totals.vertices};
        each_warps_blocks(mesh, brick, static_cast<std::uint32_t>(i % parts_of_brick), [&](const WarpBlocks& blocks) {
            blocks.each_vertex([&](bool exists, const KeptBlock& kept, std::uint32_t n, const BrickVertex& vertex) {
                if (!exists) return;
                BitsAmongOthers bits(all + place.at, first + 8 * std::uint64_t{attribute.coded_bytes} *
                                                                 (std::uint64_t{kept.before.vertices} + n));
                write_value(attribute, vertex.number, bits);
            });
        });
    }
}

/// One thread block for every brick.
__global__ void __launch_bounds__(block_threads)
    sum_words(const PackedPlace* places, std::uint32_t count, const std::byte* all, WordHash* hashes) {
    __shared__ WordHash of_warps[block_warps];
    for (std::uint32_t p = blockIdx.x; p < count; p += gridDim.x) {
        const auto* const words = reinterpret_cast<const std::uint64_t*>(all + places[p].at);
        WordHash hash{};
        for (std::uint32_t i = threadIdx.x; i < places[p].words; i += block_threads) hash.add(words[i], i);
        for (std::uint64_t& sum : hash.of)
            for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2)
                sum += __shfl_xor_sync(all_lanes, sum, static_cast<int>(distance));
        if (lane_index() == 0) of_warps[warp_in_block()] = hash;
        __syncthreads();
        if (threadIdx.x < 2) {
            std::uint64_t sum = 0;
            for (const WordHash& of_warp : of_warps) sum += of_warp.of[threadIdx.x];
            hashes[p].of[threadIdx.x] = sum;
        }
        // The next brick's sums take the place of these.
        __syncthreads();
    }
}

}  // namespace

AttributeOnDevice::AttributeOnDevice(const CodedAttribute& form, const std::byte* on_device)
    : values(on_device),
      components(static_cast<std::uint32_t>(form.components)),
      exact_bytes(static_cast<std::uint32_t>(size_of(form.type) * form.components)),
      coded_bytes(static_cast<std::uint32_t>(form.coded_bytes())),
      bits(form.bits) {
    for (std::size_t c = 0; form.bits != 0 && c < form.components; ++c) range[c] = CodedRange(form, c);
}

void pack_bricks(const LatticeOnDevice& mesh, const PackedForm& form, const PackedPlace* places, std::uint32_t count,
                 std::byte* out, const Launcher& launch) {
    launch.each((1 + std::uint64_t{parts_of_brick}) * count, write_bricks, mesh, form, places, count, out);
}

void pack_attribute(const LatticeOnDevice& mesh, const PackedForm& form, const AttributeOnDevice& attribute,
                    std::uint32_t bytes_before, const PackedPlace* places, std::uint32_t count, std::byte* out,
                    const Launcher& launch) {
    launch.each(std::uint64_t{parts_of_brick} * count, write_attribute, mesh, form, attribute, bytes_before, places,
                count, out);
}

void hash_packed_bricks(const PackedPlace* places, std::uint32_t count, const std::byte* bytes, WordHash* hashes,
                        const Launcher& launch) {
    launch(count, 1, sum_words, places, count, bytes, hashes);
}

}  // namespace meniscus::cuda
