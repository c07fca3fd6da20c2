// The data of the steps on a GPU: arrays of fixed capacity in device memory, and counts that stay there.
//
// A kernel that finds how many elements there are writes the number into Counts, with nothing beyond the capacity, and
// sets Counts::stop where that is too little. All that follows then finds no elements, and the frame runs once more
// with more room.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/block_state.hpp"
#include "engine/cuda/capacities.hpp"
#include "engine/cuda/kept_lattice.hpp"
#include "engine/cuda/scans.hpp"
#include "field/lattice_settings.hpp"
#include "lattice/blocks.hpp"
#include "lattice/level_sets.hpp"
#include "lattice/raise_times.hpp"
#include "lattice/tables/tables.hpp"
#include "lattice/word_hash.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/surface_lattice.hpp"
#include "particles/attributes.hpp"
#include "particles/neighbor_bricks.hpp"
#include "particles/particle_key.hpp"
#include "particles/particle_set.hpp"
#include "particles/payload.hpp"
#include "particles/positions.hpp"

namespace meniscus::cuda {

using Counter = unsigned long long;  // what atomicAdd takes

/// The part of the state that is sent to the device with a frame's particles.
struct FrameInput {
    std::uint32_t particles = 0;
    PositionsView positions;               ///< device pointers
    const std::uint8_t* levels = nullptr;  ///< device pointer, or none
    PayloadView payload;                   ///< device pointers
    AttributeNumbers attributes;
};

/// Words of a brick's set of clusters: 2 x 2 x 2 blocks each.
inline constexpr int cluster_words = Brick::words / 4;

/// Lists of blocks, filled in any order.
enum class List : std::uint8_t {
    corner_points,  ///< blocks to be sampled in the first round; in later ones, and for the middles of edges:
    later_round,
    edge_middles,
    half_edge_middles,
    vertices,  ///< blocks with vertices
    band,
    cracks,  ///< cells with cracks to fill
};
inline constexpr std::size_t list_count = 7;

/// Kernels that find out how much room a frame needs; see State::require_room_at_end().
enum class RoomFinder : std::uint8_t {
    support_cells,
    particles,
    blocks,
    base_samples,
    corner_samples,
    middle_samples,
    half_edge_samples,
};
inline constexpr std::size_t room_finder_count = 7;

/// Why the kernels of a frame do nothing more.
enum class Stop : std::uint32_t {
    none,
    too_little_room,         ///< an array is too small, see Counts::needed
    crowded,                 ///< the particles lie too densely, see is_crowded()
    too_much_at_particles,   ///< too much work for the sums at the particles' places, see work.hpp
    too_much_at_base_cells,  ///< too much work for the sums at the base cells
    too_many_base_cells,
    asked_for,  ///< the host asks for it, see LongLoop
};

/// A box of bricks of support cells, whose coordinates begin at zero here: no particles where all is zero.
struct BrickBox {
    static constexpr std::uint32_t axis_end = 1U << brick_axis_bits;
    std::uint32_t below[3];  ///< axis_end minus the lowest coordinate: atomicMax finds it
    std::uint32_t end[3];    ///< one past the highest coordinate

    MENISCUS_HD std::uint32_t low(int axis) const { return axis_end - below[axis]; }
    MENISCUS_HD std::uint64_t size(int axis) const { return end[axis] + below[axis] - axis_end; }
    MENISCUS_HD std::uint64_t volume() const { return end[0] == 0 ? 0 : size(0) * size(1) * size(2); }
};

/// Counts of a frame, which kernels write and read. All are zero when the frame begins.
struct Counts {
    BrickBox boxes[particle_level_count];
    std::uint64_t boxed_before[particle_level_count];  ///< number of bricks in the boxes of the levels before each
    Int3 reached_low;                ///< lowest brick of the box of bricks of base cells that particles may reach
    std::uint32_t reached_size[3];   ///< its bricks a side
    std::uint32_t boxed_blocks;      ///< number of thread blocks whose particles the boxes hold
    Counter needed[resource_count];  ///< elements that the frame needs of each resource
    std::uint32_t ended_blocks[room_finder_count];  ///< number of thread blocks of each kernel that are at its end
    Counter field_evaluations;
    Counter triangles[triangle_level_count];  ///< number of triangles of each level
    Counter sixfold_volume;                   ///< six times the volume of the mesh, see steps/fill_cracks/volume.hpp
    std::uint32_t first_triangle[triangle_level_count];  ///< index of each level's first triangle
    std::uint32_t band_cells[3];                         ///< number of cells of the band of each level
    Counter crowd;            ///< sum over the particles of those in their cell, see is_crowded()
    Counter probe_seed;       ///< seed of the choice of probes, see probed_particle()
    Counter neighbors;        ///< number of neighbors of all probed particles
    Counter pairs;            ///< number of pairs of a base cell and a particle near it
    Counter spray_particles;  ///< number of particles alone
    Counter vertices_without_particles;
    std::uint32_t greatest_sample;  ///< bits of a float; found only where the host asks for it
    std::uint32_t particle_cells;   ///< number of support cells
    std::uint32_t first_particle_brick[particle_level_count + 1];  ///< index of each level's first brick, and the end
    std::uint32_t level_particles[particle_level_count];  ///< number of particles of each level; where work is limited
    std::uint32_t listed[list_count];                     ///< number of blocks on each list
    // See Sweeps and settle_band:
    std::uint32_t found[3];        ///< number of cells that each of three successive searches of the grid has found
    std::uint32_t found_alone[3];  ///< the same for searches of its first block alone
    std::uint32_t last_to_finest;  ///< number of the last search that promoted a cell to the finest level
    std::uint32_t last_joining;    ///< number of the last search in which a cell joined the band
    std::uint32_t faces_to_settle;
    std::uint32_t stale_cells;
    std::uint32_t stale_words;
    std::uint32_t is_settled;
    Stop stop;

    /// Whether there are particles of a level.
    MENISCUS_HD bool has_level(unsigned k) const { return first_particle_brick[k + 1] != first_particle_brick[k]; }
};

template <class T>
using Pointer = T*;

struct State : BlockState<Pointer> {
    LatticeSettings settings;
    Capacities capacity;
    bool keeps_lattice = false;
    std::uint64_t payload_bytes = 0;  ///< most bytes that a frame's payload has had so far
    AttributeShape attributes;
    FrameInput* input = nullptr;
    Counts* counts = nullptr;
    const volatile std::uint32_t* stop_word =
        nullptr;  ///< the host's flag, see LongLoop; null: nothing stops the frame
    const CubeCase* cube_table = nullptr;
    const CrackCase* crack_table = nullptr;
    std::byte* scratch = nullptr;
    std::size_t scratch_bytes = 0;

    // An element for every particle. A level's particles lie together, levels in ascending order; ParticleSetView
    // explains the other members.
    SortKey* keys = nullptr;  ///< level, ParticleKey::cell and ParticleKey::place of each, in one number
    SortKey* unsorted_keys = nullptr;
    std::uint32_t* order = nullptr;  ///< index of each in the frame, in the order of support cells
    std::uint32_t* order_room = nullptr;
    // Only where particles carry a payload:
    std::uint32_t* sources = nullptr;  ///< index of each sorted particle in the frame
    float4* numbers = nullptr;         ///< each particle's numbers, group after group, see AttributeNumber

    std::uint64_t* starts = nullptr;  ///< number of support cells that begin before each, in the upper half that of
                                      ///< their bricks; one element more for the end
    float4* particles = nullptr;      ///< position and weight of each
    float* sums = nullptr;            ///< the sum at each particle's place, while weights are found
    float* falls = nullptr;           ///< fall of each kernel, see Poly6; smooth field only
    // Only where spray is listed:
    std::uint32_t* spray_before = nullptr;    ///< number of particles alone before each
    Point* spray = nullptr;                   ///< places of the particles alone
    std::uint32_t* first_particle = nullptr;  ///< index of the first particle of every support cell, and the end
    Brick* particle_bricks = nullptr;
    std::uint64_t* particle_brick_keys = nullptr;

    std::uint64_t* reached_keys = nullptr;  ///< numbers, in the box of all, of the bricks of base cells that support
                                            ///< cells reach; repeated
    std::uint64_t* unsorted_reached_keys = nullptr;
    std::uint32_t* first_of_key = nullptr;  ///< number of different keys before each, and their number in all

    // An element for every brick of base cells.
    Brick* bricks = nullptr;
    std::uint64_t* brick_keys = nullptr;
    BrickNeighbors* neighbors = nullptr;
    /// The bricks of particles near each, for every level in turn; unset where there are no particles of a level.
    NeighborBricks* neighbor_bricks = nullptr;
    std::uint64_t* members_before = nullptr;   ///< number of members of the bricks before each, and of all
    std::uint64_t* base_inside = nullptr;      ///< set of blocks, see BaseVertexSets
    std::uint64_t* raised = nullptr;           ///< set of cells that a search has found; empty between sweeps
    std::uint32_t* marked_clusters = nullptr;  ///< set of clusters on a list, see cluster.hpp; empty once it is read

    // An element for every block.
    std::uint8_t* wanted_level = nullptr;       ///< level that the split criterion asks for
    BlockMask* corner_points = nullptr;         ///< set of the points that cells of the band need as corners
    std::uint32_t* old_first_sample = nullptr;  ///< index of the first sample before the samples move
    LevelCounts* triangles_before = nullptr;    ///< number of triangles before each, by level, and of all
    std::uint32_t* chosen = nullptr;            ///< the lists up to List::vertices, one after the other
    std::uint32_t* band_cells = nullptr;
    std::uint32_t* cracked_cells = nullptr;

    // Only where the frame is a part of one:
    RaiseTimes* raise_times = nullptr;  ///< of every block
    WordHash* border_hashes = nullptr;  ///< of every brick of base cells, towards each of its neighbor slots

    // The mesh, in memory of its own: that of a frame before may be on its way to the host, from the other set of these
    // arrays.
    MeshBrick* mesh_bricks = nullptr;  ///< an element for every brick of base cells
    LatticePosition* vertices = nullptr;
    Normal* normals = nullptr;
    Triangle* triangles = nullptr;
    std::byte* vertex_attributes[max_particle_arrays] = {};
    // Only where the lattice is kept:
    LatticeBlock* lattice_blocks = nullptr;
    KeptBlock* kept_blocks = nullptr;  ///< beside each of those
    KeptBrick* kept_bricks = nullptr;

    explicit State(const LatticeSettings& lattice_settings) : BlockState{}, settings(lattice_settings) {}

    /// Calls take(name, pointer, number of elements) for every array but the mesh's.
    template <class Take>
    void for_each_array(Take& take) {
        const std::uint64_t n = capacity.particles;
        const std::uint64_t brick_count = capacity[Resource::bricks];
        const std::uint64_t blocks = capacity[Resource::blocks];
        take("input", input, 1);
        take("counts", counts, 1);
        take("cube_table", cube_table, cube_case_count);
        take("crack_table", crack_table, crack_case_count);
        take("scratch", scratch, scratch_bytes);
        take("keys", keys, n);
        take("unsorted_keys", unsorted_keys, n);
        take("order", order, n);
        take("order_room", order_room, n);
        take("sources", sources, payload_bytes != 0 ? n : 0);
        take("numbers", numbers, attributes.groups() * n);
        take("starts", starts, n + 1);
        take("particles", particles, n);
        take("sums", sums, n);
        take("falls", falls, settings.has_own_supports ? n : 0);
        take("spray_before", spray_before, settings.lists_spray ? n : 0);
        take("spray", spray, settings.lists_spray ? n : 0);
        take("first_particle", first_particle, n + 1);
        take("particle_bricks", particle_bricks, capacity[Resource::particle_bricks]);
        take("particle_brick_keys", particle_brick_keys, capacity[Resource::particle_bricks]);
        take("reached_keys", reached_keys, capacity[Resource::reached_bricks]);
        take("unsorted_reached_keys", unsorted_reached_keys, capacity[Resource::reached_bricks]);
        take("first_of_key", first_of_key, capacity[Resource::reached_bricks] + 1);
        take("bricks", bricks, brick_count);
        take("brick_keys", brick_keys, brick_count);
        take("neighbors", neighbors, brick_count);
        take("neighbor_bricks", neighbor_bricks, particle_level_count * brick_count);
        take("members_before", members_before, brick_count + 1);
        take("base_inside", base_inside, brick_count * Brick::words);
        take("raised", raised, brick_count * Brick::words);
        take("marked_clusters", marked_clusters, brick_count * cluster_words);
        for_each_set([&](const char* name, auto*& set) { take(name, set, brick_count * Brick::words); });
        for_each_block_array([&](const char* name, auto*& array) { take(name, array, blocks + 1); });
        take("wanted_level", wanted_level, blocks);
        take("corner_points", corner_points, blocks);
        take("old_first_sample", old_first_sample, blocks);
        take("triangles_before", triangles_before, blocks + 1);
        take("chosen", chosen, blocks);
        take("band_cells", band_cells, blocks);
        take("cracked_cells", cracked_cells, blocks);
        take("samples", samples, capacity[Resource::samples]);
        take("raise_times", raise_times, settings.part.is_whole ? 0 : blocks);
        take("border_hashes", border_hashes, settings.part.is_whole ? 0 : brick_count * neighbor_slots);
    }
    template <class Take>
    void for_each_mesh_array(Take& take) {
        take("mesh_bricks", mesh_bricks, capacity[Resource::bricks]);
        take("vertices", vertices, capacity[Resource::vertices]);
        take("normals", normals, settings.has_normals ? capacity[Resource::vertices] : 0);
        take("triangles", triangles, capacity[Resource::triangles]);
        for (std::uint32_t a = 0; a < attributes.arrays; ++a)
            take("vertex_attributes", vertex_attributes[a], attributes.vertex_bytes[a] * capacity[Resource::vertices]);
        const std::uint64_t kept = keeps_lattice ? capacity[Resource::lattice_blocks] : 0;
        take("lattice_blocks", lattice_blocks, kept);
        take("kept_blocks", kept_blocks, kept);
        take("kept_bricks", kept_bricks, keeps_lattice ? capacity[Resource::bricks] : 0);
    }

    /// The arrays in the form that ArrayMemory takes.
    auto arrays() {
        return [this](auto& take) { for_each_array(take); };
    }
    auto mesh_arrays() {
        return [this](auto& take) { for_each_mesh_array(take); };
    }

    /// Copies the tables to the device; the arrays have their places.
    void upload_tables(cudaStream_t stream) const {
        check(cudaMemcpyAsync(const_cast<CubeCase*>(cube_table), meniscus::cube_table.data(), sizeof(CubeTable),
                              cudaMemcpyHostToDevice, stream),
              "cudaMemcpyAsync");
        check(cudaMemcpyAsync(const_cast<CrackCase*>(crack_table), meniscus::crack_table.data(), sizeof(CrackTable),
                              cudaMemcpyHostToDevice, stream),
              "cudaMemcpyAsync");
    }

    Scratch scratch_memory() const { return {scratch, scratch_bytes}; }

    __device__ bool goes_on() const { return counts->stop == Stop::none; }
    __device__ std::uint32_t count(Resource r) const {
        return goes_on() ? static_cast<std::uint32_t>(counts->needed[static_cast<int>(r)]) : 0;
    }
    __device__ std::uint32_t listed(List l) const { return goes_on() ? counts->listed[static_cast<int>(l)] : 0; }
    /// Notes the number of elements that are needed, and stops the frame where there is no room; called by one thread,
    /// once all blocks of the grid have begun: no kernel reads a stop at its begin that it may set itself.
    __device__ void need(Resource r, std::uint64_t number) const {
        counts->needed[static_cast<int>(r)] = number;
        if (goes_on() && (number > capacity[r] || number >= too_many(r))) counts->stop = Stop::too_little_room;
    }

    /// The same for the number in Counts::needed, by all threads of a kernel as they end: its last block does it.
    __device__ void require_room_at_end(RoomFinder kernel, Resource r) const {
        __syncthreads();
        if (threadIdx.x != 0) return;
        __threadfence();
        if (atomicAdd(&counts->ended_blocks[static_cast<int>(kernel)], 1U) != gridDim.x - 1) return;
        need(r, *const_cast<volatile Counter*>(&counts->needed[static_cast<int>(r)]));
    }

    __device__ std::uint32_t particle_count() const { return goes_on() ? input->particles : 0; }

    /// The particles of a level without their coordinates, which are in `particles`.
    __device__ ParticleSetView set(unsigned k) const {
        const std::uint32_t begin = counts->first_particle_brick[k];
        const BrickGridView grid{particle_bricks + begin, particle_brick_keys + begin, nullptr,
                                 counts->first_particle_brick[k + 1] - begin};
        return {grid,
                first_particle,
                nullptr,
                nullptr,
                nullptr,
                nullptr,
                nullptr,
                settings.cell_units[k],
                settings.support[k]};
    }
    __device__ BrickGridView grid() const { return {bricks, brick_keys, neighbors, count(Resource::bricks)}; }
    __device__ BlocksView blocks() const { return blocks_view(*this, grid(), count(Resource::blocks)); }
    // Until step 5, in arrays that are not needed before: lists of cells that a rule has found, of those that may have
    // to change, of the words of bricks that hold some of these, and of faces, at most three of a cell.
    __device__ std::uint32_t* found_cells() const { return cracked_cells; }
    __device__ std::uint32_t* stale_cells() const { return band_cells; }
    __device__ std::uint32_t* stale_words() const { return reinterpret_cast<std::uint32_t*>(base_deep); }
    __device__ std::uint64_t* is_stale() const { return base_inside; }
    __device__ std::uint64_t* faces_to_settle() const { return reinterpret_cast<std::uint64_t*>(edges); }
    __device__ LevelSets level_sets() const { return level_sets_of(*this, grid()); }
};

}  // namespace meniscus::cuda
