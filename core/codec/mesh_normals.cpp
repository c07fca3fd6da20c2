#include "meniscus/mesh_normals.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "codec/lattice/corner_normals.hpp"

namespace meniscus {
namespace {

using NormalSum = std::array<double, 3>;
constexpr NormalSum no_sum{};

/// Added and taken away, it rounds a part, at most 1 in each component, to a multiple of 2^-44, the step of doubles
/// around it: such parts add up without rounding, in whatever order. The smallest that is not 0, of a triangle as large
/// as a base cell, is 2^-43.
constexpr double rounder = 384.0;

void add_triangles(const Mesh& mesh, const TriangleRange& range, std::vector<NormalSum>& sums) {
    for (std::size_t t = range.first; t < std::size_t{range.first} + range.count; ++t) {
        const Triangle& triangle = mesh.triangles[t];
        const auto add = [&](std::size_t corner, const NormalSum& part) {
            NormalSum& sum = sums[triangle[corner]];
            for (std::size_t k = 0; k < 3; ++k) sum[k] += part[k] + rounder - rounder;
        };
        add_corner_normals<double>({mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]},
                                   add);
    }
}

Normal unit(const NormalSum& sum) {
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    if (!(length > 0.0)) return {0.0F, 0.0F, 1.0F};
    return {static_cast<float>(sum[0] / length), static_cast<float>(sum[1] / length),
            static_cast<float>(sum[2] / length)};
}

}  // namespace

void compute_normals(Mesh& mesh) {
    std::vector<NormalSum> sums(mesh.vertices.size());
    constexpr auto crack = static_cast<std::size_t>(TriangleLevel::crack);
    for (std::size_t level = 0; level < crack; ++level) add_triangles(mesh, mesh.levels[level], sums);
    mesh.normals.resize(sums.size());
    bool has_bare = false;
    for (std::size_t v = 0; v < sums.size(); ++v) {
        has_bare = has_bare || sums[v] == no_sum;
        mesh.normals[v] = unit(sums[v]);
    }
    if (!has_bare) return;
    std::vector<NormalSum> filling(sums.size());
    add_triangles(mesh, mesh.levels[crack], filling);
    for (std::size_t v = 0; v < sums.size(); ++v)
        if (sums[v] == no_sum) mesh.normals[v] = unit(filling[v]);
}

}  // namespace meniscus
