// Figures of one reconstruction: counts, times, memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

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

struct Statistics {
    std::uint64_t particles = 0;
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::array<std::uint64_t, triangle_level_count> triangles_by_level{};  ///< indexed by TriangleLevel
    std::uint64_t spray_particles = 0;  ///< particles without company, whatever Settings::spray makes of them
    std::uint64_t vertices_without_particles = 0;  ///< those that no particle is near: their attributes are 0
    double volume = 0.0;           ///< enclosed by the mesh, world units cubed: exact until it is rounded here
    double particle_volume = 0.0;  ///< of the frame: the sum of (2 r)^3, world units cubed
    std::array<std::uint64_t, 3> base_cells_by_level{};  ///< cells of the surface band, levels 1, 2, 3
    std::uint64_t field_evaluations = 0;                 ///< points at which the field was summed
    std::array<double, stage_count> stage_seconds{};     ///< indexed by Stage
    double total_seconds = 0.0;                          ///< of the call that reconstructed
    double download_seconds = 0.0;   ///< copies from the GPU: part of total_seconds after reconstruct(), not after
                                     ///< reconstruct_for_download()
    std::uint64_t peak_bytes = 0;    ///< the reconstructor's arrays and the mesh
    std::uint64_t allocations = 0;   ///< made for this frame; 0 once warm
    std::uint64_t device_bytes = 0;  ///< held on the GPU; CUDA's own not counted
    std::uint64_t device_peak_bytes = 0;
    std::string backend;  ///< "cpu" or "cuda"
    unsigned threads = 0;
    std::vector<Warning> warnings;  ///< what looks like a mistake, in the order of the codes
};

}  // namespace meniscus
