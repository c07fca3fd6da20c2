// What the kernels of a frame work on: arrays of fixed capacity in device memory, and counts that stay there.
//
// A kernel that finds how many elements there are writes the number into Counts, with nothing beyond the capacity, and
// sets Counts::overflow where that is too little. All that follows then finds no elements, and the frame runs once more
// with more room.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/cuda/capacities.hpp"
#include "engine/cuda/scans.hpp"
#include "field/lattice_settings.hpp"
#include "lattice/blocks.hpp"
#include "lattice/level_sets.hpp"
#include "meniscus/mesh.hpp"
#include "particles/particle_set.hpp"
#include "steps/register_particles/register_particles.hpp"
#include "steps/split_cells/split_cells.hpp"
#include "tables/tables.hpp"

namespace meniscus::cuda {

using Counter = unsigned long long;  // what atomicAdd takes

/// Sent to the device with a frame's particles.
struct FrameInput {
    std::uint32_t particles = 0;
    PositionsView positions;               ///< device pointers
    const std::uint8_t* levels = nullptr;  ///< device pointer, or none
};

/// Lists of blocks, filled in any order.
enum class List : std::uint8_t {
    bends,          ///< cells of the band whose bend is measured
    corner_points,  ///< blocks to be sampled: first, in every later round, and for the middles of edges
    later_round,
    edge_middles,
    half_edge_middles,
    vertices,  ///< blocks with vertices
    band,
    cracks,  ///< cells with cracks to fill
};
inline constexpr std::size_t list_count = 8;

/// Zero at a frame's begin.
struct Counts {
    Counter needed[resource_count];
    Counter field_evaluations;
    Counter triangles[triangle_level_count];
    std::uint32_t first_triangle[triangle_level_count];
    std::uint32_t band_cells[3];  ///< by level
    Counter crowd;                ///< see is_crowded()
    std::uint32_t particle_cells;
    std::uint32_t first_particle_brick[particle_level_count + 1];
    std::uint32_t listed[list_count];
    std::uint32_t changed[3];  ///< see raise_levels.hpp
    std::uint32_t overflow;
};

/// Places arrays one after the other.
struct Layout {
    std::byte* memory;  ///< none: only counts
    std::size_t bytes = 0;

    template <class T>
    void operator()(T*& array, std::uint64_t elements) {
        constexpr std::size_t alignment = 256;
        bytes = (bytes + alignment - 1) / alignment * alignment;
        array = memory == nullptr ? nullptr : reinterpret_cast<T*>(memory + bytes);
        bytes += static_cast<std::size_t>(elements) * sizeof(T);
    }
};

struct Frame {
    // The user's choices.
    LatticeSettings settings;
    bool bisects = false;
    std::uint32_t bisection_steps = 0;
    bool has_normals = true;
    std::int64_t cell_units[particle_level_count] = {};
    float inverse_support[particle_level_count] = {};

    Capacities capacity;
    FrameInput* input = nullptr;
    Counts* counts = nullptr;
    const CubeCase* cube_table = nullptr;
    const CrackCase* crack_table = nullptr;
    std::byte* scratch = nullptr;
    std::size_t scratch_bytes = 0;

    // Of every particle. Those of a level lie together, levels in ascending order; ParticleSetView explains the rest.
    std::byte* upload = nullptr;  ///< 12 bytes for positions, one for the level
    SortKey* keys = nullptr;      ///< level, ParticleKey::cell, ParticleKey::place
    SortKey* unsorted_keys = nullptr;
    std::uint64_t* starts = nullptr;  ///< support cells that begin before it, and in the upper half bricks of them
    float4* particles = nullptr;      ///< position and weight
    float* densities = nullptr;       ///< color field only
    std::uint32_t* first_particle = nullptr;  ///< of every support cell, and one past the last
    Brick* particle_bricks = nullptr;
    std::uint64_t* particle_brick_keys = nullptr;

    std::uint64_t* reached_keys = nullptr;  ///< bricks of base cells that support cells reach, repeated
    std::uint64_t* unsorted_reached_keys = nullptr;
    std::uint32_t* first_of_key = nullptr;  ///< different keys before each, and one past the last

    // Of every brick of base cells.
    Brick* bricks = nullptr;
    std::uint64_t* brick_keys = nullptr;
    BrickNeighbors* neighbors = nullptr;
    std::uint64_t* members_before = nullptr;  ///< and one past the last
    std::uint64_t* base_inside = nullptr;     ///< see BaseVertexSets
    std::uint64_t* base_deep = nullptr;
    std::uint64_t* at_least[4] = {};  ///< see LevelSets
    std::uint64_t* raised = nullptr;  ///< a set of cells too; empty between sweeps

    // Of every block; BlocksView explains those that are not explained here.
    std::uint32_t* brick = nullptr;
    std::uint16_t* place = nullptr;
    std::uint8_t* level = nullptr;
    std::uint8_t* wanted_level = nullptr;  ///< by the split criterion
    BlockMask* sampled = nullptr;
    BlockMask* inside = nullptr;
    BlockMask* corner_points = nullptr;  ///< points that cells of the band need as corners
    BlockMask* wanted_points = nullptr;
    std::uint32_t* first_sample = nullptr;
    std::uint32_t* old_first_sample = nullptr;  ///< while a block's samples move
    EdgeMasks* edges = nullptr;
    std::uint32_t* first_vertex = nullptr;    ///< and one past the last
    LevelCounts* triangles_before = nullptr;  ///< by level, and one past the last
    std::uint32_t* particle_counts = nullptr;
    CellReach* reaches = nullptr;
    CellBend* bends = nullptr;
    std::uint32_t* work = nullptr;  ///< the lists up to List::vertices, one after the other
    std::uint32_t* band = nullptr;
    std::uint32_t* cracked = nullptr;

    float* samples = nullptr;

    // The mesh, in memory of its own: that of a frame before may be on its way to the host, from the other set of these
    // arrays.
    MeshBrick* mesh_bricks = nullptr;  ///< of every brick of base cells
    LatticePosition* vertices = nullptr;
    Normal* normals = nullptr;
    Triangle* triangles = nullptr;

    explicit Frame(const LatticeSettings& lattice_settings) : settings(lattice_settings) {}

    /// Gives take(pointer, number of elements) every array but the mesh's.
    template <class Take>
    void for_each_array(Take& take) {
        const std::uint64_t n = capacity.particles;
        const std::uint64_t brick_count = capacity[Resource::bricks];
        const std::uint64_t blocks = capacity[Resource::blocks];
        take(input, 1);
        take(counts, 1);
        take(cube_table, cube_case_count);
        take(crack_table, crack_case_count);
        take(scratch, scratch_bytes);
        take(upload, 13 * n);
        take(keys, n);
        take(unsorted_keys, n);
        take(starts, n);
        take(particles, n);
        take(densities, n);
        take(first_particle, n + 1);
        take(particle_bricks, capacity[Resource::particle_bricks]);
        take(particle_brick_keys, capacity[Resource::particle_bricks]);
        take(reached_keys, capacity[Resource::reached_bricks]);
        take(unsorted_reached_keys, capacity[Resource::reached_bricks]);
        take(first_of_key, capacity[Resource::reached_bricks] + 1);
        take(bricks, brick_count);
        take(brick_keys, brick_count);
        take(neighbors, brick_count);
        take(members_before, brick_count + 1);
        take(base_inside, brick_count * Brick::words);
        take(base_deep, brick_count * Brick::words);
        for (int l = 1; l <= 3; ++l) take(at_least[l], brick_count * Brick::words);
        take(raised, brick_count * Brick::words);
        take(brick, blocks);
        take(place, blocks);
        take(level, blocks);
        take(wanted_level, blocks);
        take(sampled, blocks);
        take(inside, blocks);
        take(corner_points, blocks);
        take(wanted_points, blocks);
        take(first_sample, blocks);
        take(old_first_sample, blocks);
        take(edges, blocks);
        take(first_vertex, blocks + 1);
        take(triangles_before, blocks + 1);
        take(particle_counts, blocks);
        take(reaches, blocks);
        take(bends, blocks);
        take(work, blocks);
        take(band, blocks);
        take(cracked, blocks);
        take(samples, capacity[Resource::samples]);
    }
    template <class Take>
    void for_each_mesh_array(Take& take) {
        take(mesh_bricks, capacity[Resource::bricks]);
        take(vertices, capacity[Resource::vertices]);
        take(normals, has_normals ? capacity[Resource::vertices] : 0);
        take(triangles, capacity[Resource::triangles]);
    }

    /// Gives every array its place from `memory` on (none: only counts); returns the bytes that all of them take.
    std::size_t lay_out(std::byte* memory) {
        Layout layout{memory};
        for_each_array(layout);
        return layout.bytes;
    }
    std::size_t lay_out_mesh(std::byte* memory) {
        Layout layout{memory};
        for_each_mesh_array(layout);
        return layout.bytes;
    }

    /// Where the positions' levels lie in the upload.
    std::byte* upload_levels() const { return upload + 12 * capacity.particles; }
    Scratch scratch_memory() const { return {scratch, scratch_bytes}; }

    __device__ std::uint32_t count(Resource r) const {
        return counts->overflow != 0 ? 0 : static_cast<std::uint32_t>(counts->needed[static_cast<int>(r)]);
    }
    __device__ std::uint32_t listed(List l) const {
        return counts->overflow != 0 ? 0 : counts->listed[static_cast<int>(l)];
    }
    /// Tells how many are needed; called by one thread.
    __device__ void need(Resource r, std::uint64_t number) const {
        counts->needed[static_cast<int>(r)] = number;
        if (number > capacity[r] || number >= too_many(r)) counts->overflow = 1;
    }

    /// The particles of a level, but for their coordinates, which are in `particles`.
    __device__ ParticleSetView set(unsigned k) const {
        const std::uint32_t begin = counts->first_particle_brick[k];
        const BrickGridView grid{particle_bricks + begin, particle_brick_keys + begin, nullptr,
                                 counts->first_particle_brick[k + 1] - begin};
        return {grid, first_particle, nullptr, nullptr, nullptr, nullptr, cell_units[k], settings.support[k]};
    }
    __device__ BrickGridView grid() const { return {bricks, brick_keys, neighbors, count(Resource::bricks)}; }
    __device__ BlocksView blocks() const {
        return {grid(),       count(Resource::blocks),
                brick,        place,
                level,        sampled,
                inside,       first_sample,
                samples,      edges,
                first_vertex, nullptr};
    }
    __device__ BaseVertexSets base_vertices() const { return {{grid(), base_inside}, {grid(), base_deep}}; }
    __device__ LevelSets level_sets() const {
        return {{{}, {grid(), at_least[1]}, {grid(), at_least[2]}, {grid(), at_least[3]}}};
    }
};

}  // namespace meniscus::cuda
