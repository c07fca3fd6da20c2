#include "compare/closedness.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace meniscus::compare {
namespace {

/// One of a vertex's triangles: the edge that it has across from the vertex.
struct Corner {
    std::uint32_t next;
    std::uint32_t previous;
};

/// The end of an edge at a vertex, as one of the vertex's triangles uses it.
struct EdgeUse {
    std::uint32_t other;   ///< the edge's other end
    std::uint32_t corner;  ///< index of the triangle at this vertex
    bool outgoing;         ///< the triangle runs from this vertex to the other
};

bool is_degenerate(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

std::size_t count_repeated(std::span<const Point> positions) {
    std::vector<Point> sorted(positions.begin(), positions.end());
    std::sort(sorted.begin(), sorted.end());
    std::size_t repeated = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i] == sorted[i - 1]) ++repeated;
    return repeated;
}

/// Looks at one vertex after the other; every edge is counted at its smaller end.
class VertexCheck {
public:
    explicit VertexCheck(Defects& defects) : defects_(defects) {}

    void check(std::uint32_t vertex, std::span<const Corner> corners) {
        uses_.clear();
        groups_.resize(corners.size());
        std::iota(groups_.begin(), groups_.end(), 0U);
        for (std::uint32_t i = 0; i < corners.size(); ++i) {
            uses_.push_back({corners[i].next, i, true});
            uses_.push_back({corners[i].previous, i, false});
        }
        std::sort(uses_.begin(), uses_.end(), [](const EdgeUse& a, const EdgeUse& b) { return a.other < b.other; });
        std::size_t groups = corners.size();
        for (auto use = uses_.begin(); use != uses_.end();) {
            const auto first = use;
            std::size_t outgoing = 0;
            for (; use != uses_.end() && use->other == first->other; ++use) {
                if (use->outgoing) ++outgoing;
                if (join(first->corner, use->corner)) --groups;
            }
            if (first->other < vertex) continue;
            const auto all = static_cast<std::size_t>(use - first);
            if (2 * outgoing != all) ++defects_.unbalanced_edges;
            if (all == 1) ++defects_.border_edges;
            if (all > 2) ++defects_.crowded_edges;
        }
        if (groups > 1) ++defects_.torn_vertices;
    }

private:
    std::uint32_t root(std::uint32_t corner) {
        while (groups_[corner] != corner) corner = groups_[corner] = groups_[groups_[corner]];
        return corner;
    }
    /// Whether they were in two groups.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        groups_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

    Defects& defects_;
    std::vector<EdgeUse> uses_;
    std::vector<std::uint32_t> groups_;
};

std::string counted(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

}  // namespace

Defects find_defects(SurfaceView surface) {
    Defects defects;
    defects.repeated_vertices = count_repeated(surface.positions);

    // Corners by vertex: counted, then placed.
    std::vector<std::size_t> starts(surface.positions.size() + 1, 0);
    std::vector<bool> used(surface.positions.size(), false);
    for (const Triangle& t : surface.triangles) {
        for (const std::uint32_t v : t) used[v] = true;
        if (is_degenerate(t)) {
            ++defects.degenerate_triangles;
            continue;
        }
        for (const std::uint32_t v : t) ++starts[v + 1];
    }
    defects.unused_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<Corner> corners(starts.back());
    std::vector<std::size_t> ends(starts.begin(), starts.end() - 1);
    for (const Triangle& t : surface.triangles) {
        if (is_degenerate(t)) continue;
        for (std::size_t i = 0; i < 3; ++i) corners[ends[t[i]]++] = {t[(i + 1) % 3], t[(i + 2) % 3]};
    }

    VertexCheck vertices(defects);
    for (std::uint32_t v = 0; v < surface.positions.size(); ++v)
        vertices.check(v, std::span<const Corner>(corners).subspan(starts[v], starts[v + 1] - starts[v]));
    return defects;
}

std::string Defects::text() const {
    const std::array<std::pair<std::size_t, std::pair<const char*, const char*>>, 6> all{{
        {repeated_vertices, {"repeated vertex", "repeated vertices"}},
        {unused_vertices, {"unused vertex", "unused vertices"}},
        {degenerate_triangles, {"degenerate triangle", "degenerate triangles"}},
        {unbalanced_edges, {"unbalanced edge", "unbalanced edges"}},
        {crowded_edges, {"edge of more than two triangles", "edges of more than two triangles"}},
        {torn_vertices, {"torn vertex", "torn vertices"}},
    }};
    std::string out;
    for (const auto& [count, name] : all) {
        if (count == 0) continue;
        if (!out.empty()) out += ", ";
        out += counted(count, name.first, name.second);
    }
    return out;
}

std::vector<std::string> Defects::lines() const {
    const std::array<std::pair<std::size_t, std::pair<const char*, const char*>>, 7> all{{
        {border_edges,
         {"edge of one triangle: the mesh is open there", "edges of one triangle: the mesh is open there"}},
        {unbalanced_edges - border_edges,
         {"edge whose triangles run the same way: the orientation is not consistent",
          "edges whose triangles run the same way: the orientation is not consistent"}},
        {crowded_edges,
         {"edge of more than two triangles: not manifold", "edges of more than two triangles: not manifold"}},
        {torn_vertices,
         {"vertex at which parts of the mesh only touch: not manifold",
          "vertices at which parts of the mesh only touch: not manifold"}},
        {degenerate_triangles, {"triangle with a vertex twice", "triangles with a vertex twice"}},
        {repeated_vertices, {"vertex at the place of another one", "vertices at the place of another one"}},
        {unused_vertices, {"vertex of no triangle", "vertices of no triangle"}},
    }};
    std::vector<std::string> out;
    for (const auto& [count, name] : all)
        if (count > 0) out.push_back(counted(count, name.first, name.second));
    return out;
}

}  // namespace meniscus::compare
