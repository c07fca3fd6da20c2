// What is told of a part that has been made, and summed up to the whole frame's figures.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "meniscus/mesh.hpp"
#include "meniscus/part.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {

/// What a process tells of a part that it has made.
struct MadePart {
    std::uint64_t number = 0;  ///< of the part; a sum has none
    std::uint64_t particles = 0;
    std::uint64_t vertices = 0;
    std::uint64_t own_vertices = 0;  ///< those that no part of a lesser number has
    std::array<std::uint64_t, triangle_level_count> triangles_by_level{};
    std::array<std::uint64_t, 3> base_cells_by_level{};
    std::uint64_t sixfold_volume = 0;
    std::uint64_t spray_particles = 0;
    std::uint64_t vertices_without_particles = 0;
    std::uint64_t field_evaluations = 0;
    std::array<double, stage_count> stage_seconds{};
    std::uint64_t farthest = 0;  ///< PartsReport::farthest, of its vertices
    float greatest_sample = 0.0F;

    MadePart() = default;
    MadePart(std::uint64_t part, std::uint64_t received, const Statistics& s, const PartOutcome& outcome)
        : number(part),
          particles(received),
          vertices(s.vertices),
          triangles_by_level(s.triangles_by_level),
          base_cells_by_level(s.base_cells_by_level),
          sixfold_volume(outcome.sixfold_volume),
          spray_particles(s.spray_particles),
          vertices_without_particles(s.vertices_without_particles),
          field_evaluations(s.field_evaluations),
          stage_seconds(s.stage_seconds),
          greatest_sample(outcome.greatest_sample) {}
    /// Sums, and the greatest sample of all.
    void add(const MadePart& o) {
        const auto add_all = [](auto& sums, const auto& others) {
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += others[i];
        };
        particles += o.particles;
        vertices += o.vertices;
        own_vertices += o.own_vertices;
        add_all(triangles_by_level, o.triangles_by_level);
        add_all(base_cells_by_level, o.base_cells_by_level);
        sixfold_volume += o.sixfold_volume;
        spray_particles += o.spray_particles;
        vertices_without_particles += o.vertices_without_particles;
        field_evaluations += o.field_evaluations;
        add_all(stage_seconds, o.stage_seconds);
        farthest = std::max(farthest, o.farthest);
        greatest_sample = std::max(greatest_sample, o.greatest_sample);
    }
};

}  // namespace meniscus
