// Figures of one reconstruction: counts, times, memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/described.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/names.hpp"
#include "meniscus/warning.hpp"

namespace meniscus {

/// The paper's steps (Algorithms 1 to 3), in order.
enum class Stage : std::uint8_t {
    register_particles,
    split_cells,
    adjust_levels,
    sample_field,
    count_triangles,
    place_vertices,
    emit_triangles,
    fill_cracks,
};
constexpr std::string_view name_of(Stage stage) {
    switch (stage) {
        case Stage::register_particles:
            return "register_particles";
        case Stage::split_cells:
            return "split_cells";
        case Stage::adjust_levels:
            return "adjust_levels";
        case Stage::sample_field:
            return "sample_field";
        case Stage::count_triangles:
            return "count_triangles";
        case Stage::place_vertices:
            return "place_vertices";
        case Stage::emit_triangles:
            return "emit_triangles";
        case Stage::fill_cracks:
            return "fill_cracks";
    }
    return {};
}
inline constexpr std::size_t stage_count = choices<Stage>.size();

/// Of one frame, of those that come from a server: what follows is left out.
inline constexpr std::size_t max_warnings = 16;

struct Statistics {
    std::uint64_t particles = 0;
    std::uint64_t spray_particles = 0;
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::array<std::uint64_t, triangle_level_count> triangles_by_level{};  ///< indexed by TriangleLevel
    std::array<std::uint64_t, 3> base_cells_by_level{};                    ///< levels 1, 2, 3
    std::uint64_t vertices_without_particles = 0;
    double volume = 0.0;
    double particle_volume = 0.0;
    std::uint64_t field_evaluations = 0;
    std::array<double, stage_count> stage_seconds{};  ///< indexed by Stage
    double download_seconds = 0.0;  ///< part of total_seconds after reconstruct(), not after reconstruct_for_download()
    double total_seconds = 0.0;     ///< of the call that reconstructed
    std::uint64_t peak_bytes = 0;
    std::uint64_t allocations = 0;
    std::uint64_t device_bytes = 0;
    std::uint64_t device_peak_bytes = 0;
    std::string backend;
    unsigned threads = 0;
    std::vector<Warning> warnings;  ///< in the order of the codes

    template <class Visit>
    static void rows(const Visit& visit) {
        using S = Statistics;
        constexpr std::span<const std::string_view> levels = names<TriangleLevel>;
        visit("particles", &S::particles, {.help = "particles of the frame"});
        visit("spray_particles", &S::spray_particles,
              {.help = "particles without company, whatever the setting spray makes of them"});
        visit("vertices", &S::vertices, {.help = "vertices of the mesh"});
        visit("triangles", &S::triangles, {.help = "triangles of the mesh"});
        visit("triangles_by_level", &S::triangles_by_level, {.help = "triangles by level of grid", .entries = levels});
        visit("base_cells_by_level", &S::base_cells_by_level,
              {.help = "cells of the surface band of levels 1, 2, 3", .entries = levels.first(3)});
        visit("vertices_without_particles", &S::vertices_without_particles,
              {.help = "vertices that no particle is near: their attributes are 0"});
        visit("volume", &S::volume,
              {.help = "volume that the mesh encloses, exact until it is rounded here", .unit = "world units cubed"});
        visit("particle_volume", &S::particle_volume,
              {.help = "volume of the frame's particles: the sum of (2 r)^3", .unit = "world units cubed"});
        visit("field_evaluations", &S::field_evaluations, {.help = "points at which the field was summed"});
        visit("stage_seconds", &S::stage_seconds,
              {.help = "time of each of the paper's steps", .unit = "s", .entries = names<Stage>});
        visit("download_seconds", &S::download_seconds, {.help = "time of copies from the GPU", .unit = "s"});
        visit("total_seconds", &S::total_seconds, {.help = "time of the reconstruction", .unit = "s"});
        visit("peak_bytes", &S::peak_bytes,
              {.help = "most memory of the reconstruction and the mesh", .unit = "bytes"});
        visit("allocations", &S::allocations, {.help = "allocations for this frame; 0 once warm"});
        visit("device_bytes", &S::device_bytes,
              {.help = "memory on the GPU, but for that of CUDA itself", .unit = "bytes"});
        visit("device_peak_bytes", &S::device_peak_bytes, {.help = "most memory on the GPU", .unit = "bytes"});
        visit("backend", &S::backend, {.help = "\"cpu\" or \"cuda\""});
        visit("threads", &S::threads, {.help = "worker threads"});
        visit("warnings", &S::warnings, {.help = "what looks like a mistake", .range = {.most = max_warnings}});
    }
};

}  // namespace meniscus
