#include "support/mesh_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <unordered_map>
#include <vector>

namespace meniscus::test {
namespace {

/// Union-find.
class Groups {
public:
    explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
    std::size_t find(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

private:
    std::vector<std::size_t> parent_;
};

struct HalfEdge {
    std::uint64_t edge;  ///< smaller vertex, larger vertex
    std::uint32_t triangle;
    std::uint8_t start;  ///< corner of the triangle
    bool upward;
};

}  // namespace

std::string MeshReport::text() const {
    std::ostringstream out;
    out << "repeated " << repeated_vertices << ", unused " << unused_vertices << ", degenerate " << degenerate_triangles
        << ", unbalanced edges " << unbalanced_edges << ", non-manifold edges " << nonmanifold_edges
        << ", non-manifold vertices " << nonmanifold_vertices << ", volume " << volume << ", area " << area
        << ", components " << components;
    return out.str();
}

MeshReport check(const Mesh& mesh) {
    MeshReport report;
    std::vector<LatticePosition> sorted(mesh.vertices.begin(), mesh.vertices.end());
    std::sort(sorted.begin(), sorted.end());
    report.repeated_vertices =
        sorted.size() - static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());

    std::vector<HalfEdge> half_edges;
    std::vector<char> used(mesh.vertices.size(), 0);
    Groups parts(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& triangle = mesh.triangles[t];
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[0] == triangle[2])
            ++report.degenerate_triangles;
        for (std::uint8_t i = 0; i < 3; ++i) {
            const std::uint64_t a = triangle[i];
            const std::uint64_t b = triangle[(i + 1U) % 3];
            used[a] = 1;
            parts.join(a, b);
            half_edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, i, a < b});
        }
        std::array<std::array<double, 3>, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.world(mesh.vertices[triangle[i]]);
        const auto origin = mesh.world(mesh.vertices[mesh.triangles[0][0]]);
        for (auto& q : p)
            for (std::size_t k = 0; k < 3; ++k) q[k] -= origin[k];
        const auto cross = [](const auto& u, const auto& v) {
            return std::array<double, 3>{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                         u[0] * v[1] - u[1] * v[0]};
        };
        const auto c = cross(p[0], p[1]);
        report.volume += (c[0] * p[2][0] + c[1] * p[2][1] + c[2] * p[2][2]) / 6.0;
        const std::array<double, 3> u{p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
        const std::array<double, 3> v{p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
        const auto n = cross(u, v);
        report.area += std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2.0;
    }
    report.unused_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
    std::set<std::size_t> roots;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v] != 0) roots.insert(parts.find(v));
    report.components = roots.size();

    std::sort(half_edges.begin(), half_edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.edge < b.edge; });
    // Corners of triangles that share an edge belong to the same fan at both of its ends.
    Groups corners(3 * mesh.triangles.size());
    const auto corner_of = [&](const HalfEdge& h, bool lower_vertex) {
        const std::size_t local = h.upward == lower_vertex ? h.start : (h.start + 1U) % 3;
        return 3 * std::size_t{h.triangle} + local;
    };
    for (std::size_t i = 0; i < half_edges.size();) {
        std::size_t end = i;
        std::ptrdiff_t balance = 0;
        for (; end < half_edges.size() && half_edges[end].edge == half_edges[i].edge; ++end) {
            balance += half_edges[end].upward ? 1 : -1;
            corners.join(corner_of(half_edges[i], true), corner_of(half_edges[end], true));
            corners.join(corner_of(half_edges[i], false), corner_of(half_edges[end], false));
        }
        if (balance != 0) ++report.unbalanced_edges;
        if (end - i > 2) ++report.nonmanifold_edges;
        i = end;
    }
    std::vector<std::size_t> fan(mesh.vertices.size(), SIZE_MAX);
    std::set<std::size_t> torn;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t v = mesh.triangles[t][i];
            const std::size_t group = corners.find(3 * t + i);
            if (fan[v] == SIZE_MAX)
                fan[v] = group;
            else if (fan[v] != group)
                torn.insert(v);
        }
    report.nonmanifold_vertices = torn.size();
    return report;
}

}  // namespace meniscus::test
