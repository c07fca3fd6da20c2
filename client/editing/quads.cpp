#include "editing/quads.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace meniscus::editing {
namespace {

using formats::Quad;
using formats::TriangleMesh;
using Vector = std::array<double, 3>;

Vector between(const Vector& a, const Vector& b) {
    return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}
double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector& a) {
    return std::sqrt(dot(a, a));
}

/// Degrees between two vectors; none if one of them has no direction.
std::optional<double> angle(const Vector& a, const Vector& b) {
    const double lengths = length(a) * length(b);
    if (!(lengths > 0.0)) return std::nullopt;
    return std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// A triangle's edge: from its corner `corner` to the next.
struct EdgeUse {
    std::uint32_t low, high;  ///< its vertices
    std::uint32_t triangle;
    std::uint8_t corner;
};

/// Two triangles that may become one quadrilateral.
struct Candidate {
    double fault;  ///< degrees by which the worst of the corners departs from a right angle
    std::uint32_t first, second;
    Quad corners;
};

/// Sorted by their vertices, then by their triangles.
std::vector<EdgeUse> edges_of(const TriangleMesh& mesh) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::uint8_t c = 0; c < 3; ++c) {
            const std::uint32_t a = mesh.triangles[i][c];
            const std::uint32_t b = mesh.triangles[i][(c + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), i, c});
        }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    return uses;
}

/// The first's corners, with the second's far corner between the ends of the shared edge; from the first's corner
/// across that edge on. None if they do not run in one direction, or meet in more than an edge.
std::optional<Quad> corners_of(const TriangleMesh& mesh, const EdgeUse& one, const EdgeUse& other) {
    const Triangle& a = mesh.triangles[one.triangle];
    const Triangle& b = mesh.triangles[other.triangle];
    if (a[one.corner] != b[(other.corner + 1U) % 3]) return std::nullopt;
    const Quad quad{a[(one.corner + 2U) % 3], a[one.corner], b[(other.corner + 2U) % 3], a[(one.corner + 1U) % 3]};
    if (quad[0] == quad[2]) return std::nullopt;
    return quad;
}

/// The candidate's `fault`; none if the quadrilateral does not meet the criteria. Its first diagonal is the shared
/// edge.
std::optional<double> fault_of(const TriangleMesh& mesh, const Quad& quad, const QuadCriteria& criteria) {
    const auto at = [&](std::size_t i) -> const Vector& { return mesh.positions[quad[i % 4]]; };
    const auto normals =
        angle(cross(between(at(0), at(1)), between(at(0), at(3))), cross(between(at(2), at(3)), between(at(2), at(1))));
    if (!normals || *normals > criteria.largest_normal_angle) return std::nullopt;
    const std::array diagonals{length(between(at(1), at(3))), length(between(at(0), at(2)))};
    double fault = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double edge = length(between(at(i), at(i + 1)));
        for (const double diagonal : diagonals)
            if (edge > criteria.largest_edge_ratio * diagonal || diagonal > criteria.largest_edge_ratio * edge)
                return std::nullopt;
        // At the ends of the shared edge the corner is the sum of two, which may exceed 180 degrees.
        auto corner = angle(between(at(i), at(i + 1)), between(at(i), at(i + 3)));
        if (i % 2 == 1) {
            const auto left = angle(between(at(i), at(i + 1)), between(at(i), at(i + 2)));
            const auto right = angle(between(at(i), at(i + 2)), between(at(i), at(i + 3)));
            if (!left || !right) return std::nullopt;
            corner = *left + *right;
        }
        if (!corner || *corner > criteria.largest_corner_angle) return std::nullopt;
        fault = std::max(fault, std::abs(*corner - 90.0));
    }
    return fault;
}

std::vector<Candidate> candidates_of(const TriangleMesh& mesh, const QuadCriteria& criteria) {
    const std::vector<EdgeUse> uses = edges_of(mesh);
    std::vector<Candidate> candidates;
    for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
        while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) ++end;
        if (end - i != 2) continue;
        const EdgeUse& one = uses[i];
        const EdgeUse& other = uses[i + 1];
        if (!mesh.levels.empty() && mesh.levels[one.triangle] != mesh.levels[other.triangle]) continue;
        const auto corners = corners_of(mesh, one, other);
        if (!corners) continue;
        if (const auto fault = fault_of(mesh, *corners, criteria))
            candidates.push_back({*fault, one.triangle, other.triangle, *corners});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        if (a.fault != b.fault) return a.fault < b.fault;
        return std::array{a.first, a.second} < std::array{b.first, b.second};
    });
    return candidates;
}

}  // namespace

void merge_to_quads(TriangleMesh& mesh, const QuadCriteria& criteria) {
    std::vector<bool> merged(mesh.triangles.size(), false);
    std::vector<Candidate> chosen;
    for (const Candidate& candidate : candidates_of(mesh, criteria)) {
        if (merged[candidate.first] || merged[candidate.second]) continue;
        merged[candidate.first] = merged[candidate.second] = true;
        chosen.push_back(candidate);
    }
    std::sort(chosen.begin(), chosen.end(), [](const Candidate& a, const Candidate& b) { return a.first < b.first; });
    for (const Candidate& pair : chosen) {
        mesh.quads.push_back(pair.corners);
        if (!mesh.levels.empty()) mesh.quad_levels.push_back(mesh.levels[pair.first]);
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (merged[i]) continue;
        mesh.triangles[left] = mesh.triangles[i];
        if (!mesh.levels.empty()) mesh.levels[left] = mesh.levels[i];
        ++left;
    }
    mesh.triangles.resize(left);
    if (!mesh.levels.empty()) mesh.levels.resize(left);
}

}  // namespace meniscus::editing
